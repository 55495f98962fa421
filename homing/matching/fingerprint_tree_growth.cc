// The tree's growth; fingerprint_tree.cc searches it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "homing/matching/fingerprint_tree.h"

namespace homing {
namespace {

// When a bucket is split, a factor of two in the number of vectors counts as this many pixels.
constexpr float kPixelsPerOctave = 24;

// A cut of entries: the first `left` ones have a key below `split`.
struct Cut {
  float split = 0;
  std::size_t left = 0;
};

// Cuts near `middle`; entries with the lowest key `low` are never alone on the right. One function
// per key, so that each key is read in place.
template <typename Key>
Cut CutAt(std::span<TreeEntry> entries, std::size_t middle, float low, Key key) {
  const auto at = entries.begin() + static_cast<std::ptrdiff_t>(middle);
  std::nth_element(entries.begin(), at, entries.end(),
                   [key](const TreeEntry& a, const TreeEntry& b) { return key(a) < key(b); });
  float split = key(*at);
  // Entries from here on are not below.
  auto end = at;
  if (split == low) {
    split = std::numeric_limits<float>::infinity();
    for (const TreeEntry& entry : entries) {
      split = key(entry) > low ? std::min(split, key(entry)) : split;
    }
    end = entries.end();
  }
  const auto right = std::partition(entries.begin(), end,
                                    [&](const TreeEntry& entry) { return key(entry) < split; });
  return {split, static_cast<std::size_t>(right - entries.begin())};
}

Cut CutBy(std::uint32_t dimension, std::span<TreeEntry> entries, std::size_t middle, float low) {
  switch (dimension) {
    case 0:
      return CutAt(entries, middle, low, [](const TreeEntry& entry) { return entry.x; });
    case 1:
      return CutAt(entries, middle, low, [](const TreeEntry& entry) { return entry.y; });
    default:
      return CutAt(entries, middle, low,
                   [](const TreeEntry& entry) { return static_cast<float>(entry.count); });
  }
}

}  // namespace

FingerprintTree::Box FingerprintTree::BoxOf(std::span<const TreeEntry> entries) {
  Box box{KeysOf(entries.front()), KeysOf(entries.front())};
  for (const TreeEntry& entry : entries) {
    const auto keys = KeysOf(entry);
    for (std::size_t k = 0; k < kDimensions; ++k) {
      box.low[k] = std::min(box.low[k], keys[k]);
      box.high[k] = std::max(box.high[k], keys[k]);
    }
  }
  return box;
}

void FingerprintTree::Put(Bucket& bucket, const TreeEntry& entry) {
  const auto i = static_cast<std::size_t>(bucket.size++);
  bucket.x[i] = entry.x;
  bucket.y[i] = entry.y;
  bucket.count[i] = entry.count;
  bucket.landmark[i] = entry.landmark;
  bucket.step[i] = entry.step;
  const auto keys = KeysOf(entry);
  for (std::size_t k = 0; k < kDimensions; ++k) {
    bucket.box.low[k] = i == 0 ? keys[k] : std::min(bucket.box.low[k], keys[k]);
    bucket.box.high[k] = i == 0 ? keys[k] : std::max(bucket.box.high[k], keys[k]);
  }
}

void FingerprintTree::Insert(const TreeEntry& entry) {
  if (root_ == kNone) {
    root_ = NewBucket() | kBucket;
  }
  const auto keys = KeysOf(entry);
  std::uint32_t* reference = &root_;
  while ((*reference & kBucket) == 0) {
    Node& node = nodes_[*reference];
    reference = keys[node.dimension] < node.split ? &node.left : &node.right;
  }
  InsertAt(reference, entry);
}

void FingerprintTree::InsertAt(std::uint32_t* reference, const TreeEntry& entry) {
  Bucket& bucket = buckets_[*reference & ~kBucket];
  if (bucket.next == kNone && bucket.size < kCapacity) {
    return Put(bucket, entry);
  }
  const std::uint32_t dimension = WidestDimension(bucket.box);
  if (dimension < kDimensions) {
    Split(reference, dimension);
    Node& node = nodes_[*reference];
    const bool left = KeysOf(entry)[dimension] < node.split;
    return InsertAt(left ? &node.left : &node.right, entry);
  }
  if (bucket.box.low == KeysOf(entry)) {
    return PutInChain(*reference & ~kBucket, entry);
  }
  SplitOff(reference, entry);
}

// kDimensions: all its entries are at one place.
std::uint32_t FingerprintTree::WidestDimension(const Box& box) {
  std::uint32_t widest = kDimensions;
  float most = 0;
  for (std::uint32_t k = 0; k < kDimensions; ++k) {
    const float extent =
        k < 2 ? box.high[k] - box.low[k] : kPixelsPerOctave * std::log2(box.high[k] / box.low[k]);
    if (box.high[k] > box.low[k] && (widest == kDimensions || extent > most)) {
      most = extent;
      widest = k;
    }
  }
  return widest;
}

void FingerprintTree::Split(std::uint32_t* reference, std::uint32_t dimension) {
  const Bucket whole = buckets_[*reference & ~kBucket];
  std::array<float, kCapacity> keys{};
  for (int i = 0; i < whole.size; ++i) {
    keys[static_cast<std::size_t>(i)] = KeysOf(EntryAt(whole, i))[dimension];
  }
  auto* const end = keys.data() + whole.size;
  std::nth_element(keys.data(), keys.data() + whole.size / 2, end);
  float split = keys[static_cast<std::size_t>(whole.size / 2)];
  const float low = *std::min_element(keys.data(), end);
  if (split == low) {
    // The next greater key, so that entries with the lowest key are not alone on the right.
    split = whole.box.high[dimension];
    for (int i = 0; i < whole.size; ++i) {
      const float key = keys[static_cast<std::size_t>(i)];
      split = key > low ? std::min(split, key) : split;
    }
  }
  const Node node{split, dimension, *reference, NewBucket() | kBucket};
  buckets_[node.left & ~kBucket] = Bucket();
  for (int i = 0; i < whole.size; ++i) {
    const TreeEntry entry = EntryAt(whole, i);
    const bool left = KeysOf(entry)[dimension] < split;
    Put(buckets_[(left ? node.left : node.right) & ~kBucket], entry);
  }
  *reference = nodes_.Add(node);
}

// Splits `entry` off a chain of entries that all lie at another place.
void FingerprintTree::SplitOff(std::uint32_t* reference, const TreeEntry& entry) {
  const auto there = buckets_[*reference & ~kBucket].box.low;
  const auto keys = KeysOf(entry);
  std::uint32_t dimension = 0;
  while (keys[dimension] == there[dimension]) {
    ++dimension;
  }
  const std::uint32_t fresh = NewBucket();
  Put(buckets_[fresh], entry);
  Node node{std::max(keys[dimension], there[dimension]), dimension, *reference, fresh | kBucket};
  if (keys[dimension] < there[dimension]) {
    std::swap(node.left, node.right);
  }
  *reference = nodes_.Add(node);
}

void FingerprintTree::PutInChain(std::uint32_t bucket, const TreeEntry& entry) {
  const std::uint32_t head = bucket;
  while (buckets_[bucket].size == kCapacity && buckets_[bucket].next != kNone) {
    bucket = buckets_[bucket].next;
  }
  if (buckets_[bucket].size == kCapacity) {
    // Insert behind the head: free space stays near.
    bucket = NewBucket();
    buckets_[bucket].next = buckets_[head].next;
    buckets_[head].next = bucket;
  }
  Put(buckets_[bucket], entry);
}

void FingerprintTree::Build(std::span<TreeEntry> entries) {
  if (!entries.empty()) {
    root_ = BuildTree(entries);
  }
}

std::uint32_t FingerprintTree::BuildTree(std::span<TreeEntry> entries) {
  if (entries.size() <= kBuilt) {
    return BuildChain(entries);
  }
  const Box box = BoxOf(entries);
  const std::uint32_t dimension = WidestDimension(box);
  if (dimension == kDimensions) {
    return BuildChain(entries);
  }
  // The left side gets a whole number of buckets.
  const std::size_t buckets = (entries.size() + kBuilt - 1) / kBuilt;
  const auto [split, left_size] =
      CutBy(dimension, entries, buckets / 2 * kBuilt, box.low[dimension]);
  const std::uint32_t node = nodes_.Add({split, dimension, kNone, kNone});
  const std::uint32_t left_tree = BuildTree(entries.first(left_size));
  nodes_[node].left = left_tree;
  const std::uint32_t right_tree = BuildTree(entries.subspan(left_size));
  nodes_[node].right = right_tree;
  return node;
}

// One bucket, or a chain if all entries lie at one place.
std::uint32_t FingerprintTree::BuildChain(std::span<const TreeEntry> entries) {
  const std::uint32_t head = NewBucket();
  for (const TreeEntry& entry : entries) {
    if (buckets_[head].size < kCapacity) {
      Put(buckets_[head], entry);
    } else {
      PutInChain(head, entry);
    }
  }
  return head | kBucket;
}

void FingerprintTree::RemoveIf(std::uint32_t first, std::uint32_t buckets,
                               const std::function<bool(const TreeEntry&)>& unwanted) {
  const std::uint32_t left = bucket_count() - std::min(first, bucket_count());
  for (std::uint32_t b = first; b < first + std::min(left, buckets); ++b) {
    const Bucket before = buckets_[b];
    Bucket after;
    after.next = before.next;
    for (int i = 0; i < before.size; ++i) {
      if (const TreeEntry entry = EntryAt(before, i); !unwanted(entry)) {
        Put(after, entry);
      }
    }
    // The box of a chain stays: all its entries lie at one place.
    after.box = before.box;
    buckets_[b] = after;
  }
}

}  // namespace homing
