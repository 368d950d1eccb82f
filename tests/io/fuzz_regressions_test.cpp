#include "fuzz/fuzz_target.hpp"
#include "io/io_testing.hpp"

namespace cmap::testing {
namespace {

constexpr std::pair<const char*, fuzz::Reader> kReaders[] = {
    {"any", fuzz::read_any},          {"colmap_binary", read_colmap_binary},
    {"kitti_bin", read_kitti_bin},    {"colmap_text", read_colmap_text},
    {"las", fuzz::read_las_as_it_is}, {"npy", read_npy_cloud},
    {"npz", read_npz_cloud},          {"obj", read_obj_points},
    {"opensfm", read_opensfm},        {"pcd", read_pcd},
    {"ply", read_ply},                {"ptx", read_ptx},
