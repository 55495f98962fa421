#include "homing/profile/profile_blocks.h"

#ifdef __x86_64__

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "homing/profile/cell_costs.h"

#define HOMING_AVX2 __attribute__((target("avx2")))

namespace homing {
namespace {

constexpr std::size_t kCodes = 16;
// Profiles of a block.
constexpr std::size_t kBlock = 32;
constexpr std::size_t kCells = FlowProfile::kCells;
// Cells that are transposed at a time.
constexpr std::size_t kTile = 16;

// Costs indexed by seen code, then by stored code.
struct CostTables {
  alignas(kCodes) std::array<std::array<std::uint8_t, kCodes>, kCodes> count{};
  alignas(kCodes) std::array<std::array<std::uint8_t, kCodes>, kCodes> parallax{};
};

constexpr CostTables MakeCostTables() {
  CostTables tables;
  for (std::uint8_t seen = 0; seen < kCodes; ++seen) {
    for (std::uint8_t stored = 0; stored < kCodes; ++stored) {
      tables.count[seen][stored] = CountCost(seen, stored);
      tables.parallax[seen][stored] = ParallaxCost(seen, stored);
    }
  }
  return tables;
}
constexpr CostTables kCosts = MakeCostTables();

// One byte of each profile of a block.
struct Row {
  __m256i bytes;
};

// By cell, the codes of the block's profiles.
struct Block {
  std::array<Row, kCells> count;
  std::array<Row, kCells> parallax;
};

// A cell that counts, and its seen codes.
struct CountedCell {
  std::uint8_t cell = 0;
  std::uint8_t codes = 0;
};

// The cells of one view that count.
class CountedCells {
 public:
  // Branches would be mispredicted, so each cell is written to every list where it may belong.
  explicit CountedCells(const ProfileView& view) {
    std::size_t full = 0;
    std::size_t empty = 0;
    for (std::uint8_t cell = 0; cell < kCells; ++cell) {
      const std::uint8_t codes = view.seen.cells[cell];
      cells_[full] = cells_[kCells - 1 - empty] = {cell, codes};
      // A cell without seen vectors has no parallax to compare.
      const unsigned counts = view.covered[cell] & 1U;
      const unsigned has_parallax = codes >> 4U != 0 ? 1 : 0;
      full += counts & has_parallax;
      empty += counts & (1 - has_parallax);
    }
    full_ = full;
    empty_ = empty;
  }
  std::span<const CountedCell> full() const { return std::span(cells_).first(full_); }
  std::span<const CountedCell> empty() const { return std::span(cells_).last(empty_); }

 private:
  std::array<CountedCell, kCells> cells_;
  std::size_t full_ = 0;
  std::size_t empty_ = 0;
};

// Rows of 16 bytes become columns, in each half of the registers.
HOMING_AVX2 inline void Transpose(std::array<Row, kTile>& rows) {
  for (int round = 0; round < 4; ++round) {
    std::array<Row, kTile> next;
    for (std::size_t i = 0; i < kTile / 2; ++i) {
      const __m256i a = rows[i].bytes;
      const __m256i b = rows[i + kTile / 2].bytes;
      next[2 * i].bytes = _mm256_unpacklo_epi8(a, b);
      next[2 * i + 1].bytes = _mm256_unpackhi_epi8(a, b);
    }
    rows = next;
  }
}

const FlowProfile* ProfileAt(std::span<const FlowProfile> stored, std::size_t i) {
  return &stored[i];
}
const FlowProfile* ProfileAt(std::span<const FlowProfile* const> stored, std::size_t i) {
  return stored[i];
}

// Fills up an incomplete block with the last profile.
template <typename Profiles>
HOMING_AVX2 void Fill(Profiles stored, Block& block) {
  const __m256i low = _mm256_set1_epi8(15);
  std::array<const FlowProfile*, kBlock> of;
  for (std::size_t i = 0; i < kBlock; ++i) {
    of[i] = ProfileAt(stored, std::min(i, stored.size() - 1));
  }
  const auto part = [&of](std::size_t profile, std::size_t cell) {
    return reinterpret_cast<const __m128i*>(of[profile]->cells.data() + cell);
  };
  for (std::size_t tile = 0; tile < kCells; tile += kTile) {
    std::array<Row, kTile> rows;
    for (std::size_t i = 0; i < kTile; ++i) {
      rows[i].bytes = _mm256_loadu2_m128i(part(i + kTile, tile), part(i, tile));
    }
    Transpose(rows);
    for (std::size_t i = 0; i < kTile; ++i) {
      const __m256i codes = rows[i].bytes;
      block.count[tile + i].bytes = _mm256_and_si256(codes, low);
      block.parallax[tile + i].bytes = _mm256_and_si256(_mm256_srli_epi16(codes, 4), low);
    }
  }
}

// Looks the codes of 32 profiles up in a table of 16 costs.
HOMING_AVX2 inline __m256i LookUp(const std::uint8_t* costs, const Row& codes) {
  const __m128i table = _mm_load_si128(reinterpret_cast<const __m128i*>(costs));
  return _mm256_shuffle_epi8(_mm256_broadcastsi128_si256(table), codes.bytes);
}

template <bool with_parallax>
HOMING_AVX2 inline __m256i CostOf(const Block& block, const CountedCell& cell) {
  const __m256i count = LookUp(kCosts.count[cell.codes & 15U].data(), block.count[cell.cell]);
  if constexpr (with_parallax) {
    const auto& costs = kCosts.parallax[cell.codes >> 4U];
    return _mm256_add_epi8(count, LookUp(costs.data(), block.parallax[cell.cell]));
  }
  return count;
}

// Sums of 32 profiles, 16 bits each.
struct Sums {
  __m256i low;
  __m256i high;
};

HOMING_AVX2 inline void Add(__m256i bytes, Sums& sums) {
  const __m256i zero = _mm256_setzero_si256();
  sums.low = _mm256_add_epi16(sums.low, _mm256_unpacklo_epi8(bytes, zero));
  sums.high = _mm256_add_epi16(sums.high, _mm256_unpackhi_epi8(bytes, zero));
}

// The costs of three cells fit in a byte.
template <bool with_parallax>
HOMING_AVX2 inline void AddCells(const Block& block, std::span<const CountedCell> cells,
                                 Sums& sums) {
  for (; cells.size() >= 3; cells = cells.subspan(3)) {
    const __m256i two = _mm256_add_epi8(CostOf<with_parallax>(block, cells[0]),
                                        CostOf<with_parallax>(block, cells[1]));
    Add(_mm256_add_epi8(two, CostOf<with_parallax>(block, cells[2])), sums);
  }
  for (const CountedCell& cell : cells) Add(CostOf<with_parallax>(block, cell), sums);
}

HOMING_AVX2 void Measure(const Block& block, const CountedCells& cells,
                         std::span<std::uint16_t> distances) {
  Sums sums{_mm256_setzero_si256(), _mm256_setzero_si256()};
  AddCells<true>(block, cells.full(), sums);
  AddCells<false>(block, cells.empty(), sums);
  alignas(32) std::array<std::uint16_t, kBlock> all;
  auto* const to = reinterpret_cast<__m256i*>(all.data());
  _mm256_store_si256(to, _mm256_permute2x128_si256(sums.low, sums.high, 0x20));
  _mm256_store_si256(to + 1, _mm256_permute2x128_si256(sums.low, sums.high, 0x31));
  std::copy_n(all.begin(), distances.size(), distances.begin());
}

template <typename Profiles>
HOMING_AVX2 void MeasureAll(std::span<const ProfileView> views, Profiles stored) {
  std::vector<CountedCells> cells(views.begin(), views.end());
  Block block;
  for (std::size_t first = 0; first < stored.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, stored.size() - first);
    Fill(stored.subspan(first, count), block);
    for (std::size_t view = 0; view < views.size(); ++view) {
      Measure(block, cells[view], views[view].distances.subspan(first, count));
    }
  }
}

}  // namespace

bool ProfileBlocksFit() {
  static const bool fit = __builtin_cpu_supports("avx2") != 0;
  return fit;
}

void ProfileDistancesByBlocks(std::span<const ProfileView> views,
                              std::span<const FlowProfile> stored) {
  MeasureAll(views, stored);
}

void ProfileDistancesByBlocks(std::span<const ProfileView> views,
                              std::span<const FlowProfile* const> stored) {
  MeasureAll(views, stored);
}

}  // namespace homing

#else

namespace homing {

bool ProfileBlocksFit() { return false; }
// Never called without AVX2.
void ProfileDistancesByBlocks(std::span<const ProfileView> /*views*/,
                              std::span<const FlowProfile> /*stored*/) {}
void ProfileDistancesByBlocks(std::span<const ProfileView> /*views*/,
                              std::span<const FlowProfile* const> /*stored*/) {}

}  // namespace homing

#endif
