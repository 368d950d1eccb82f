#include <nlohmann/json.hpp>

#include "cmap/recon/reconstruction.hpp"
#include "recon/room_capture.hpp"

namespace cmap {
namespace resume_test {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using testing::read_bytes;

/// A room that was reconstructed once, with the files of its stages.
class Resume : public ::testing::Test {
 protected:
  Reconstruction run(bool resume, const ReconstructionOptions& options = {}, Stage last = Stage::kFusion) const {
    ReconstructionRun how;
    how.stages = stages_;
    how.resume = resume;
    how.last = last;
    return reconstruct(room_.open(), options, how);
  }
  fs::path file(const char* stage) const { return stages_ / fmt::format("{}.json", stage); }

  void edit(const char* stage, const char* place, const Json& value) const {
    Json json = Json::parse(read_bytes(file(stage)));
    json.at(Json::json_pointer(place)) = value;
    std::ofstream(file(stage)) << json.dump();
  }

  test::RoomCapture room_;
  fs::path stages_ = room_.beside("stages");
  Reconstruction first_ = run(false);
};

void expect_same(const Reconstruction& a, const Reconstruction& b) {
  testing::expect_same_cloud(a.map, b.map);
  ASSERT_EQ(a.trajectory.size(), b.trajectory.size());
  for (std::size_t i = 0; i < a.trajectory.size(); ++i) {
    EXPECT_EQ(a.trajectory[i].time_s, b.trajectory[i].time_s);
    EXPECT_EQ(a.trajectory[i].position, b.trajectory[i].position);
    EXPECT_EQ(a.trajectory[i].rotation.coeffs(), b.trajectory[i].rotation.coeffs());
  }
  EXPECT_EQ(a.graph.cost_after, b.graph.cost_after);
  EXPECT_EQ(a.graph.iterations, b.graph.iterations);
  EXPECT_EQ(a.links.size(), b.links.size());
  EXPECT_EQ(a.warnings.size(), b.warnings.size());
}

TEST_F(Resume, GivesTheSameToTheLastBit) {
  ASSERT_GT(first_.map.size(), 10'000U);
  expect_same(run(true), first_);
}

TEST_F(Resume, TouchesNoFileOfAStage) {
  std::map<fs::path, fs::file_time_type> written;
  for (const auto& entry : fs::directory_iterator(stages_)) written[entry.path()] = entry.last_write_time();
  EXPECT_EQ(written.size(), 3U) << "pre-fusion, registration and pose graph";
  run(true);
  for (const auto& entry : fs::directory_iterator(stages_)) {
    EXPECT_EQ(entry.last_write_time(), written.at(entry.path())) << entry.path();
  }
}

/// Session 1 is spoiled in a way that neither name, size nor time tells: whoever reads it, ends.
TEST_F(Resume, DoesNotRunAStageAgain) {
  const fs::path depth = room_.session(1) / "depth.npy";
  const auto time = fs::last_write_time(depth);
  std::string bytes = read_bytes(depth);
  std::fill(bytes.begin(), bytes.end(), 'x');
  std::ofstream(depth, std::ios::binary) << bytes;
  fs::last_write_time(depth, time);
  const Reconstruction resumed = run(true, {}, Stage::kPoseGraph);
  ASSERT_EQ(resumed.poses.size(), first_.poses.size());
  for (std::size_t k = 0; k < resumed.poses.size(); ++k) {
    for (std::size_t i = 0; i < resumed.poses[k].T_world_camera.size(); ++i) {
      EXPECT_EQ(resumed.poses[k].T_world_camera[i].matrix(), first_.poses[k].T_world_camera[i].matrix());
    }
  }
  EXPECT_TRUE(run(false, {}, Stage::kPoseGraph).sessions.at(1).dropped) << "that is what running again does";
}

/// What stands in the files is what is taken.
TEST_F(Resume, TakesEachStageFromItsFile) {
  edit("posegraph", "/found/summary/iterations", 77);
  EXPECT_EQ(run(true).graph.iterations, 77);
  edit("registration", "/found/sessions/0/outcome/rmse_m", 0.125);
  EXPECT_EQ(run(true).sessions.at(0).rmse_m, 0.125);
  fs::remove(file("registration"));
  edit("prefusion", "/found/sessions/0/outcome/linearity", 0.25);
  EXPECT_EQ(run(true).sessions.at(0).linearity, 0.25);
}

TEST_F(Resume, AnotherOptionOrInputFindsAllAgain) {
  edit("registration", "/found/sessions/0/outcome/rmse_m", 0.125);
  ReconstructionOptions options;
  options.graph.motion_sigma_deg *= 2.0;
  EXPECT_NE(run(true, options, Stage::kRegistration).sessions.at(0).rmse_m, 0.125);

  run(false);
  edit("registration", "/found/sessions/0/outcome/rmse_m", 0.125);
  fs::last_write_time(room_.path() / "lidar.csv", fs::file_time_type::clock::now());
  EXPECT_NE(run(true).sessions.at(0).rmse_m, 0.125);
}

TEST_F(Resume, AnotherVersionFindsAllAgain) {
  edit("prefusion", "/found/sessions/0/outcome/linearity", 0.25);
  edit("prefusion", "/key/version", "0.0.1");
  fs::remove(file("registration"));
  EXPECT_NE(run(true, {}, Stage::kRegistration).sessions.at(0).linearity, 0.25);
}

TEST_F(Resume, ADamagedFileIsFoundAgain) {
  for (const char* stage : {"prefusion", "registration", "posegraph"}) {
    const std::string whole = read_bytes(file(stage));
    std::ofstream(file(stage)) << whole.substr(0, whole.size() / 2);
    expect_same(run(true), first_);
    EXPECT_EQ(read_bytes(file(stage)), whole) << "and written anew";
  }
  // A layout that an earlier state of the program had.
  Json json = Json::parse(read_bytes(file("registration")));
  json["found"]["sessions"][0].erase("center_factor");
  json["found"]["sessions"][1]["T_world_session"]["scale"] = 9.0;
  std::ofstream(file("registration")) << json.dump();
  expect_same(run(true), first_);
}

}  // namespace resume_test
}  // namespace cmap
