#include "score_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

namespace cmap {
namespace score_table_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TableCell number(double value, const std::string& text = "") {
  return {text.empty() ? std::to_string(value) : text, value, Mark::kNone, ""};
}

TableCell nothing(const std::string& text = "-") { return {text, {}, Mark::kNone, ""}; }

std::vector<Mark> marks_of(std::vector<TableCell> cells, std::string_view better) {
  std::vector<TableCell*> pointers;
  for (TableCell& cell : cells) pointers.push_back(&cell);
  mark_best(pointers, better);
  std::vector<Mark> marks;
  for (const TableCell& cell : cells) marks.push_back(cell.mark);
  return marks;
}

constexpr Mark kNone = Mark::kNone, kBest = Mark::kBest, kSecond = Mark::kSecond;

TEST(Marks, FollowTheDirection) {
  const std::vector<TableCell> cells{number(3), number(-1), number(2), number(4)};
  EXPECT_THAT(marks_of(cells, "lower"), ElementsAre(kNone, kBest, kSecond, kNone));
  EXPECT_THAT(marks_of(cells, "higher"), ElementsAre(kSecond, kNone, kNone, kBest));
  EXPECT_THAT(marks_of(cells, ""), ElementsAre(kNone, kNone, kNone, kNone)) << "no direction, no best";
}

TEST(Marks, TiesShareTheirMark) {
  EXPECT_THAT(marks_of({number(1), number(1), number(2), number(2), number(3)}, "lower"),
              ElementsAre(kBest, kBest, kSecond, kSecond, kNone));
  EXPECT_THAT(marks_of({number(1), number(1)}, "higher"), ElementsAre(kBest, kBest));
}

TEST(Marks, ValuesThatLookTheSameTie) {
  EXPECT_THAT(marks_of({number(0.82498, "82.50"), number(0.825, "82.50"), number(0.7, "70.00")}, "higher"),
              ElementsAre(kBest, kBest, kSecond));
}

TEST(Marks, NothingIsNeverBest) {
  EXPECT_THAT(marks_of({nothing(), number(5), nothing("x"), number(4)}, "lower"),
              ElementsAre(kNone, kSecond, kNone, kBest));
  EXPECT_THAT(marks_of({nothing(), number(5)}, "lower"), ElementsAre(kNone, kNone)) << "nothing to compare with";
  EXPECT_THAT(marks_of({nothing(), nothing()}, "lower"), ElementsAre(kNone, kNone));
}

ScoreTable small_table() {
  ScoreTable table{"t", "Chamfer ↓", {"method"}, {"A", "B_2"}, {}, {"a note"}};
  table.rows.push_back({{"Ours & co"}, {number(1, "1.000"), nothing("x")}});
  table.rows.push_back({{"x|y"}, {number(12, "12.00"), nothing()}});
  for (std::size_t column = 0; column < 2; ++column) mark_best(cells_of(table, column), "lower");
  return table;
}

TEST(Typeset, Text) {
  EXPECT_EQ(typeset({small_table()}, TableFormat::kText),
            "Chamfer ↓\n"
            "method         A   B_2\n"
            "Ours & co  1.000*    x\n"
            "x|y        12.00+    -\n"
            "\n"
            "a note\n");
}

TEST(Typeset, Markdown) {
  EXPECT_EQ(typeset({small_table()}, TableFormat::kMarkdown),
            "### Chamfer ↓\n\n"
            "| method | A | B\\_2 |\n"
            "| --- | ---: | ---: |\n"
            "| Ours &amp; co | **1.000** | x |\n"
            "| x\\|y | *12.00* | - |\n"
            "\n"
            "- a note\n");
}

TEST(Typeset, Latex) {
  EXPECT_EQ(typeset({small_table()}, TableFormat::kLatex),
            "% needs \\usepackage{booktabs,graphicx} and \\usepackage[table]{xcolor}\n"
            "\\begin{table}[t]\n\\centering\n\\caption{Chamfer $\\downarrow$}\n"
            "\\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}{%\n"
            "\\begin{tabular}{lrr}\n\\toprule\n"
            "  method & A & B\\_2 \\\\\n\\midrule\n"
            "  Ours \\& co & \\cellcolor{red!35}1.000 & $\\times$ \\\\\n"
            "  x\\textbar{}y & \\cellcolor{orange!35}12.00 & -- \\\\\n"
            "\\bottomrule\n\\end{tabular}}\n"
            "\\par\\smallskip{\\footnotesize a note}\n"
            "\\end{table}\n");
}

TEST(Typeset, ABandStandsBehindItsValue) {
  ScoreTable table{"t", "", {"method"}, {"A"}, {}, {}};
  table.rows.push_back({{"x"}, {{"0.298", 0.298, Mark::kBestUntested, "", "± 0.097"}}});
  table.rows.push_back({{"y"}, {number(1, "12.50")}});
  EXPECT_EQ(typeset({table}, TableFormat::kText),
            "method               A\n"
            "x       0.298? ± 0.097\n"
            "y                12.50\n");
  EXPECT_THAT(typeset({table}, TableFormat::kMarkdown), HasSubstr("| x | 0.298? ± 0.097 |"));
  EXPECT_THAT(typeset({table}, TableFormat::kLatex), HasSubstr("x & \\cellcolor{gray!25}0.298 $\\pm$ 0.097 \\\\"));
  std::vector<ScoreTable> tables{table};
  remove_bands(tables);
  EXPECT_THAT(typeset(tables, TableFormat::kMarkdown), HasSubstr("| x | 0.298? |"));
}

TEST(Typeset, LatexHasMinusSigns) {
  ScoreTable table{"t", "", {"method"}, {"A"}, {}, {}};
  table.rows.push_back({{"V-Long"}, {number(-1.5, "-1.500 (-5.0 %)")}});
  EXPECT_THAT(typeset({table}, TableFormat::kLatex), HasSubstr("  V-Long & $-$1.500 ($-$5.0 \\%) \\\\\n"));
}

TEST(Typeset, NotesOfSeveralTablesStandOnceAtTheEnd) {
  const std::string text = typeset({small_table(), small_table()}, TableFormat::kText);
  EXPECT_EQ(text.find("a note"), text.rfind("a note"));
  EXPECT_TRUE(text.ends_with("\na note\n"));
}

TEST(Escape, Latex) {
  EXPECT_EQ(escaped_latex("V-Sim(3)_a%b#c$d&e{f}g~h^i\\j<k>l"),
            "V-Sim(3)\\_a\\%b\\#c\\$d\\&e\\{f\\}g\\textasciitilde{}h\\textasciicircum{}i\\textbackslash{}j\\textless{}k"
            "\\textgreater{}l");
  EXPECT_EQ(escaped_latex("[a]* \"b\"|"), "{[}a{]}{*} ''b''\\textbar{}") << "nothing that the row before would take";
  EXPECT_EQ(escaped_latex("+∞"), "+$\\infty$");
  EXPECT_EQ(escaped_latex("unit RGB^2 ↓ <= 0.2 m"), "unit RGB$^2$ $\\downarrow$ $\\leq$ 0.2 m");
}

TEST(Escape, Html) { EXPECT_EQ(escaped_html("<script>\"a\"&'b'"), "&lt;script&gt;&quot;a&quot;&amp;&#39;b&#39;"); }

TEST(Escape, Markdown) {
  EXPECT_EQ(escaped_markdown("a|b*c_d`e[f](g)<h>\\"), "a\\|b\\*c\\_d\\`e\\[f\\](g)&lt;h&gt;\\\\");
}

TEST(Escape, Csv) {
  EXPECT_EQ(csv_field("plain name"), "plain name");
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("say \"hi\""), "\"say \"\"hi\"\"\"");
  EXPECT_EQ(csv_number(0.1), "0.1");
  EXPECT_EQ(csv_number({}), "");
  EXPECT_EQ(csv_number(0.835), "0.8350") << "no spreadsheet reads that as 835";
  EXPECT_EQ(csv_number(-1.25e-5), "-1.25e-05");
  EXPECT_EQ(csv_number(-1.234e-5), "-1.2340e-05");
  EXPECT_EQ(csv_number(12.5), "12.5");
  EXPECT_EQ(csv_number(1234.0), "1234");
  EXPECT_EQ(csv_number(0.8351), "0.8351");
  EXPECT_EQ(csv_number(INFINITY), "inf");
  EXPECT_EQ(csv_digits("0.125"), "0.1250");
  EXPECT_EQ(csv_digits(""), "");
}

TEST(Escape, LinesStayLines) {
  EXPECT_EQ(one_line("a\nb\tc\x1b[31m"), "a b c [31m");
  EXPECT_EQ(one_line("caf\xe9"), "caf\xef\xbf\xbd") << "no UTF-8";
  EXPECT_EQ(one_line("µm ↓"), "µm ↓");
  EXPECT_EQ(one_line("a\xe2\x80\xae"
                     "b"),
            "a b")
      << "nothing turns the direction of writing around";
}

}  // namespace score_table_test
}  // namespace cmap
