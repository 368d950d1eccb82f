"""Is a LaTeX file of tables well formed? By pdflatex where it is installed, by a small parser everywhere."""

import re
import shutil
import subprocess


def cells_of(row):
    return len(re.findall(r"(?<!\\)&", row)) + 1


def check_latex(test, text, folder):
    """Balanced braces and environments, as many cells in each row as the tabular has columns, nothing unescaped."""
    body = re.sub(r"(?<!\\)%.*", "", text)
    depth = 0
    for brace in re.findall(r"(?<!\\)[{}]", body.replace("\\\\", "")):
        depth += 1 if brace == "{" else -1
        test.assertGreaterEqual(depth, 0, "a brace closes what is not open")
    test.assertEqual(depth, 0, "braces")
    environments = []
    for kind, name in re.findall(r"\\(begin|end)\{(\w+)\}", body):
        if kind == "begin":
            environments.append(name)
        else:
            test.assertEqual(environments.pop(), name)
    test.assertEqual(environments, [])
    test.assertEqual(len(re.findall(r"(?<!\\)\$", body)) % 2, 0, "mathematics")
    test.assertNotRegex(body, r"(?<!\\)#")
    test.assertNotRegex(re.sub(r"\$[^$]*\$", "", body), r"(?<!\\)[_^]")
    for columns, rows in re.findall(r"\\begin\{tabular\}\{([lcr]+)\}(.*?)\\end\{tabular\}", body, re.S):
        for row in rows.split("\\\\\n"):
            row = re.sub(r"\\(top|mid|bottom)rule\n?", "", row).strip()
            if row:
                test.assertEqual(cells_of(row), len(columns), row)
    if shutil.which("pdflatex"):
        document = "\\documentclass{article}\\usepackage[T1]{fontenc}\\usepackage{booktabs,graphicx}\\usepackage[table]{xcolor}"
        (folder / "check.tex").write_text(f"{document}\\begin{{document}}{text}\\end{{document}}")
        result = subprocess.run(
            ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "check.tex"], cwd=folder, capture_output=True
        )
        test.assertEqual(result.returncode, 0, result.stdout[-2000:])
