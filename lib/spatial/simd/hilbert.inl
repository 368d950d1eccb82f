// Hilbert keys in blocks (Skilling, "Programming the Hilbert curve", 2004), branch-free so that compilers vectorize.

namespace cmap::CMAP_LANES {
namespace {

constexpr int kKeyBlock = 256;

struct CellBlock {
  alignas(64) std::uint32_t axis[3][kKeyBlock];
};

inline void quantize(const Eigen::Vector3f* positions, int n, const CurveGrid& grid, CellBlock& cells) {
  constexpr float kLast = static_cast<float>((1 << kCellBits) - 1);
  const float* xyz = reinterpret_cast<const float*>(positions);
  for (int a = 0; a < 3; ++a) {
    for (int i = 0; i < n; ++i) {
      float cell = (xyz[3 * i + a] - grid.min[a]) * grid.cells_per_m[a];
      cell = cell > 0.0f ? cell : 0.0f;
      cell = cell < kLast ? cell : kLast;
      cells.axis[a][i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(cell));
    }
  }
}

inline std::uint32_t all_bits_if(std::uint32_t condition) { return condition != 0 ? ~0u : 0u; }

/// One step of the curve's rotations for the second and third axis.
inline void invert_or_exchange(std::uint32_t* __restrict x, std::uint32_t* __restrict v, std::uint32_t bit) {
  const std::uint32_t below = bit - 1;
  for (int i = 0; i < kKeyBlock; ++i) {
    const std::uint32_t invert = all_bits_if(v[i] & bit);
    const std::uint32_t exchange = (x[i] ^ v[i]) & below & ~invert;
    x[i] ^= (below & invert) | exchange;
    v[i] ^= exchange;
  }
}

/// Axes to the transposed Hilbert index, in place.
inline void hilbert_transpose(CellBlock& cells) {
  std::uint32_t* const x = cells.axis[0];
  for (std::uint32_t bit = 1u << (kCellBits - 1); bit > 1; bit >>= 1) {
    for (int i = 0; i < kKeyBlock; ++i) x[i] ^= (bit - 1) & all_bits_if(x[i] & bit);
    invert_or_exchange(x, cells.axis[1], bit);
    invert_or_exchange(x, cells.axis[2], bit);
  }
  for (int i = 0; i < kKeyBlock; ++i) {
    const std::uint32_t y = cells.axis[1][i] ^ x[i];
    const std::uint32_t z = cells.axis[2][i] ^ y;
    std::uint32_t flip = 0;
    for (std::uint32_t bit = 1u << (kCellBits - 1); bit > 1; bit >>= 1) flip ^= (z & bit) != 0 ? bit - 1 : 0u;
    x[i] ^= flip;
    cells.axis[1][i] = y ^ flip;
    cells.axis[2][i] = z ^ flip;
  }
}

/// The bits of an 11-bit number, three places apart.
inline std::uint64_t spread(std::uint64_t v) {
  v = (v | v << 16) & 0x00ff0000ff0000ffull;
  v = (v | v << 8) & 0xf00f00f00f00f00full;
  v = (v | v << 4) & 0x30c30c30c30c30c3ull;
  return (v | v << 2) & 0x9249249249249249ull;
}

void hilbert_keys(const Eigen::Vector3f* positions, std::size_t n, const CurveGrid& grid, std::uint64_t first_index,
                  std::uint64_t* keys) {
  CellBlock cells{};
  for (std::size_t begin = 0; begin < n; begin += kKeyBlock) {
    const int count = n - begin < kKeyBlock ? static_cast<int>(n - begin) : kKeyBlock;
    quantize(positions + begin, count, grid, cells);
    hilbert_transpose(cells);
    for (int i = 0; i < count; ++i) {
      const std::uint64_t key =
          spread(cells.axis[0][i]) << 2 | spread(cells.axis[1][i]) << 1 | spread(cells.axis[2][i]);
      keys[begin + static_cast<std::size_t>(i)] =
          key << kIndexBits | (first_index + begin + static_cast<std::size_t>(i));
    }
  }
}

}  // namespace
}  // namespace cmap::CMAP_LANES
