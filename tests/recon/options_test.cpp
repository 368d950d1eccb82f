#include "cmap/recon/options.hpp"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "cmap/core/error.hpp"

namespace cmap {
namespace options_test {

using Json = nlohmann::ordered_json;

std::set<std::string> changed_from_default(const ReconstructionOptions& options) {
  const Json before = to_json({}), after = to_json(options);
  std::set<std::string> keys;
  for (const auto& [key, value] : before.items()) {
    if (after.at(key) != value) keys.insert(key);
  }
  return keys;
}

/// A value that this option may have, too.
Json another(const Json& value) {
  if (value.is_boolean()) return !value.get<bool>();
  if (value.is_number_integer()) return value.get<int>() + 1;
  if (value.is_number()) return value == 0.0 ? 0.5 : 1.005 * value.get<double>();
  const std::map<std::string, std::string> others{
      {"depth", "head"}, {"interpolated", "nearest"}, {"joint", "paper"}, {"depths", "centers"}, {"robust", "paper"}};
  return others.at(value.get<std::string>());
}

/// No name is read into the field of another.
TEST(ReconstructionOptions, EachSetsItselfAlone) {
  const Json defaults = to_json({});
  EXPECT_GT(defaults.size(), 50U);
  for (const auto& [key, value] : defaults.items()) {
    ReconstructionOptions options;
    apply_reconstruction_config(options, Json{{key, another(value)}}.dump(), "here");
    EXPECT_EQ(changed_from_default(options), std::set<std::string>{key});
    EXPECT_EQ(to_json(options).at(key), another(value));
  }
}

TEST(ReconstructionOptions, AllThatIsPrintedIsRead) {
  ReconstructionOptions options;
  apply_reconstruction_preset(options, "paper");
  ReconstructionOptions read;
  apply_reconstruction_config(read, to_json(options).dump(), "here");
  EXPECT_EQ(to_json(read), to_json(options));
}

TEST(ReconstructionOptions, ThePaperDiffersInWhatItsTextSays) {
  ReconstructionOptions options;
  apply_reconstruction_preset(options, "paper");
  EXPECT_EQ(changed_from_default(options),
            (std::set<std::string>{"pairing", "rotation", "overlap_scale", "voting", "registration", "lidar_priors"}));
  EXPECT_THROW(apply_reconstruction_preset(options, "moon"), UsageError);
}

TEST(ReconstructionOptions, MethodsHaveTheNamesOfTheCommandLine) {
  ReconstructionOptions options;
  for (const auto& [name, method] :
       {std::pair("prefusion", SessionRegistrationMethod::kPrefusion),
        std::pair("normal", SessionRegistrationMethod::kNormal), std::pair("paper", SessionRegistrationMethod::kPaper),
        std::pair("robust", SessionRegistrationMethod::kRobust)}) {
    set_reconstruction_option(options, std::string("registration=") + name);
    EXPECT_EQ(options.registration.method, method);
  }
  EXPECT_THROW(set_reconstruction_option(options, "registration=best"), UsageError);
}

TEST(ReconstructionOptions, RefusesWhatIsOutOfRange) {
  ReconstructionOptions options;
  for (const char* wrong : {"registration_voxel_m=0", "confidence_lowest_share=1.1", "voting_least_tolerance=1",
                            "link_min_pixels=2", "registration_neighbors=4", "motion_reach=0", "motion_reach=1.5",
                            "fusion_doubt=-0.1", "voting_seed=-1", "moon=1"}) {
    EXPECT_THROW(set_reconstruction_option(options, wrong), UsageError) << wrong;
  }
  EXPECT_EQ(changed_from_default(options), std::set<std::string>{});
}

}  // namespace options_test
}  // namespace cmap
