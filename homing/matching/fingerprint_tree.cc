#include "homing/matching/fingerprint_tree.h"

#include <algorithm>
#include <cmath>

#include "homing/base/vector_clones.h"

namespace homing {
namespace {

// Rounding error of float when it is compared with a double.
constexpr double kRounding = 1e-6;

// Prefetches all columns at once, so that their cache misses overlap.
template <typename... Columns>
void Prefetch(const Columns&... columns) {
  constexpr std::size_t kCacheLine = 64 / sizeof(float);
  for (const auto* column : {reinterpret_cast<const float*>(columns.data())...}) {
    for (std::size_t i = 0; i < 64; i += kCacheLine) {
      __builtin_prefetch(column + i);
    }
  }
}

float Ratio(float a, float b) { return std::min(a, b) / std::max(a, b); }

// An upper bound of P_T for each of `size` entries in columns.
HOMING_VECTOR_CLONES
void BoundAll(const float* x, const float* y, const std::int32_t* count, int size,
              const TreeQuery& query, const float* table, float* bounds) {
  const float query_count = static_cast<float>(query.count);
  for (int i = 0; i < size; ++i) {
    const float dx = x[i] - query.x;
    const float dy = y[i] - query.y;
    const float stored = static_cast<float>(count[i]);
    const float ratio = std::min(stored, query_count) / std::max(stored, query_count);
    bounds[i] = table[SurvivalBound::IndexOf(dx * dx + dy * dy)] * ratio;
  }
}

}  // namespace

// The state of one search.
struct FingerprintTree::Walk {
  const TreeQuery query;
  const std::array<float, 2> at;
  const SurvivalBound& bound;
  TreeVisitor* const visitor;
  SearchCost* const cost;
  // A heap: the region with the greatest bound is on top.
  std::vector<Region> regions;

  float least() const { return static_cast<float>(visitor->least() * (1 - kRounding)); }
  float BoundOf(const Region& region) const {
    const auto& away = region.away;
    return bound.At(away[0] * away[0] + away[1] * away[1]) * region.ratio;
  }
  void Push(Region region) {
    region.bound = BoundOf(region);
    if (region.bound >= least()) {
      regions.push_back(region);
      std::push_heap(regions.begin(), regions.end());
    }
  }
  Region Pop() {
    std::pop_heap(regions.begin(), regions.end());
    const Region region = regions.back();
    regions.pop_back();
    return region;
  }
  // Considers the best entry first, so that most others need not be computed.
  void ConsiderBestFirst(const Bucket& bucket, const std::array<float, kCapacity>& bounds) {
    std::array<std::pair<float, int>, kCapacity> candidates;
    auto end = candidates.begin();
    for (int i = 0; i < bucket.size; ++i) {
      const float most = bounds[static_cast<std::size_t>(i)];
      if (most >= least()) {
        *end++ = {most, i};
      }
    }
    std::make_heap(candidates.begin(), end);
    for (; end != candidates.begin() && candidates.front().first >= least(); --end) {
      visitor->Consider(EntryAt(bucket, candidates.front().second));
      std::pop_heap(candidates.begin(), end);
    }
  }
  bool MayHold(const Box& box) const {
    std::array<float, 2> away{};
    for (std::size_t i = 0; i < 2; ++i) {
      away[i] = std::max({box.low[i] - at[i], at[i] - box.high[i], 0.0F});
    }
    const float count = static_cast<float>(query.count);
    const float ratio = Ratio(std::clamp(count, box.low[2], box.high[2]), count);
    return bound.At(away[0] * away[0] + away[1] * away[1]) * ratio >= least();
  }
};

TreeEntry FingerprintTree::EntryAt(const Bucket& bucket, int index) {
  const auto i = static_cast<std::size_t>(index);
  return {bucket.x[i], bucket.y[i], bucket.count[i], bucket.landmark[i], bucket.step[i]};
}

// Descends to the bucket nearest to the query; the other sides are queued.
std::uint32_t FingerprintTree::Descend(const Region& from, Walk* walk) const {
  Region here = from;
  const float count = static_cast<float>(walk->query.count);
  while ((here.reference & kBucket) == 0) {
    const Node& node = nodes_[here.reference];
    Region other = here;
    bool left = false;
    if (node.dimension < 2) {
      const float at = walk->at[node.dimension];
      left = at < node.split;
      // If the query is outside the region, the region may already lie beyond the split.
      other.away[node.dimension] = std::max(other.away[node.dimension], std::abs(node.split - at));
    } else {
      left = count < node.split;
      other.ratio = std::min(other.ratio, Ratio(count, node.split));
    }
    here.reference = left ? node.left : node.right;
    other.reference = left ? node.right : node.left;
    walk->Push(other);
  }
  return here.reference & ~kBucket;
}

void FingerprintTree::ScanBucket(std::uint32_t bucket, Walk* walk) const {
  alignas(64) std::array<float, kCapacity> bounds;
  for (; bucket != kNone; bucket = buckets_[bucket].next) {
    const Bucket& b = buckets_[bucket];
    Prefetch(b.x, b.y, b.count);
    if (!walk->MayHold(b.box)) {
      continue;
    }
    BoundAll(b.x.data(), b.y.data(), b.count.data(), kCapacity, walk->query, walk->bound.table(),
             bounds.data());
    walk->cost->visited += b.size;
    walk->ConsiderBestFirst(b, bounds);
  }
}

void FingerprintTree::Search(const TreeQuery& query, const SurvivalBound& bound,
                             TreeVisitor* visitor, SearchCost* cost) const {
  if (root_ == kNone) {
    return;
  }
  Walk walk{query, {query.x, query.y}, bound, visitor, cost, {}};
  walk.regions.reserve(128);
  walk.Push({1, root_, {}, 1});
  while (!walk.regions.empty()) {
    const Region region = walk.Pop();
    if (region.bound < walk.least()) {
      return;
    }
    ScanBucket(Descend(region, &walk), &walk);
  }
}

}  // namespace homing
