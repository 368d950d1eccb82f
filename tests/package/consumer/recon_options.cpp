// Links the reconstruction of the installed library.

#include <cmap/recon/options.hpp>

int main() {
  cmap::ReconstructionOptions options;
  cmap::apply_reconstruction_config(options, R"({"fusion_voxel_m": 0.1})", "here");
  return options.fusion.voxel_m == 0.1 ? 0 : 1;
}
