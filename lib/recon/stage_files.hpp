#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "described_state.hpp"

namespace cmap {

/// What the stages of a run found, for a later run to go on from: one JSON file for each stage, with the key of what it
/// was found from. An empty folder name keeps nothing.
class StageFiles {
 public:
  using Json = nlohmann::ordered_json;

  StageFiles(std::filesystem::path folder, bool resume, Json key);

  /// What an earlier run found from the same key, or else what `work` finds, which is kept. Whatever is not as this
  /// program wrote it is found again.
  template <class Work>
  auto found(std::string_view stage, const Work& work) const {
    using Out = decltype(work());
    if (const auto json = load(stage)) {
      if (auto out = state_from<Out>(*json)) return std::move(*out);
    }
    Out out = work();
    save(stage, state_json(out));
    return out;
  }

 private:
  /// None unless resuming.
  std::optional<Json> load(std::string_view stage) const;
  void save(std::string_view stage, const Json& found) const;

  std::filesystem::path folder_;
  bool resume_;
  Json key_;
};

}  // namespace cmap
