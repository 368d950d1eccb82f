#include "cmap/recon/reconstruction_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cmap/core/version.hpp"
#include "posegraph/stage.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

std::string number_or_dash(double value) { return std::isnan(value) ? "-" : fmt::format("{:.3f}", value); }

std::string session_line(const SessionOutcome& s) {
  std::string line = fmt::format("{:<14} {:>6}", s.name, s.frames);
  if (s.dropped) return line + "  dropped: " + *s.dropped + "\n";
  return line + fmt::format("  {:>8.4g}  {:>6.4f}  {:>9.4f}  {:>6}  {:>7}  {:>7}\n", s.scale_prefusion,
                            s.scale_registration, s.linearity, s.scale_inlier ? "yes" : "no", number_or_dash(s.overlap),
                            number_or_dash(s.rmse_m));
}

}  // namespace

Json sessions_json(const Reconstruction& r) { return {{"sessions", state_json(r.sessions)}}; }

Json reconstruction_json(const Reconstruction& r, const ReconstructionOptions& options, const std::string& command) {
  Json warnings = Json::array(), stages = Json::object();
  for (const Warning& w : r.warnings) warnings.push_back({{"id", w.id}, {"message", w.message}});
  for (const auto& [stage, seconds] : r.stage_seconds) stages[std::string(stage_name(stage))] = seconds;
  Json pose_graph{{"links", r.links.size()}};
  pose_graph.update(state_json(r.graph));
  return {{"schema", "cmap.reconstruction/1"},
          {"tool", {{"name", "cmap"}, {"version", kVersion}}},
          {"options", to_json(options)},
          {"sessions", sessions_json(r).at("sessions")},
          {"pose_graph", pose_graph},
          {"map", {{"points", r.map.size()}, {"points_fused", r.points_fused}}},
          {"warnings", warnings},
          {"run", {{"command", command}, {"stages", stages}}}};
}

std::string reconstruction_table(const Reconstruction& r) {
  std::string text = "session        frames  scale s1      s2  linearity  inlier  overlap   RMSE m\n";
  for (const SessionOutcome& session : r.sessions) text += session_line(session);
  if (r.map.size() > 0) text += fmt::format("map: {} points of {} pixels\n", r.map.size(), r.points_fused);
  for (const auto& [stage, seconds] : r.stage_seconds)
    text += fmt::format("{}: {:.1f} s\n", stage_name(stage), seconds);
  return text;
}

}  // namespace cmap
