// A tree of fingerprints of one deviation model and side, over mean x, mean y and number of
// vectors. A search visits regions in the order of the greatest P_T that they can hold. Source:
// Bentley, "Multidimensional binary search trees", 1975, with buckets.
#ifndef HOMING_MATCHING_FINGERPRINT_TREE_H_
#define HOMING_MATCHING_FINGERPRINT_TREE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "homing/matching/chunked_array.h"
#include "homing/matching/survival_bound.h"

namespace homing {

// One fingerprint in 20 bytes. x and y: mean midpoint, source pixels.
struct TreeEntry {
  float x = 0;
  float y = 0;
  std::int32_t count = 0;
  std::uint32_t landmark = 0;
  std::uint32_t step = 0;
};

// Receives the entries that a search finds.
class TreeVisitor {
 public:
  virtual ~TreeVisitor() = default;
  // The P_T of `entry` may reach `least()`.
  virtual void Consider(const TreeEntry& entry) = 0;
  // Entries with a smaller P_T are not needed any more; it never decreases.
  double least() const { return least_; }

 protected:
  double least_ = 0;
};

struct TreeQuery {
  float x = 0;
  float y = 0;
  // Number of vectors, > 0.
  std::int32_t count = 0;
};

// The cost of a search.
struct SearchCost {
  // Fingerprints in the visited buckets.
  std::int64_t visited = 0;
};

// Each insertion puts an entry in its final place: there is no rebuilding. Not thread-safe; any
// number of threads may search while none changes it.
class FingerprintTree {
 public:
  // REQUIRES: finite mean, count > 0.
  void Insert(const TreeEntry& entry);
  // Inserts all entries at once, into fuller buckets. REQUIRES: the tree is empty; as Insert.
  // Reorders `entries`.
  void Build(std::span<TreeEntry> entries);
  // Visits every entry whose P_T reaches visitor->least(), and some others.
  void Search(const TreeQuery& query, const SurvivalBound& bound, TreeVisitor* visitor,
              SearchCost* cost) const;
  // Removes the entries for which `unwanted` is true from `buckets` buckets, starting at `first`.
  void RemoveIf(std::uint32_t first, std::uint32_t buckets,
                const std::function<bool(const TreeEntry&)>& unwanted);

  std::uint32_t bucket_count() const { return buckets_.size(); }
  std::size_t MemoryBytes() const { return nodes_.MemoryBytes() + buckets_.MemoryBytes(); }

 private:
  static constexpr int kCapacity = 64;
  // Entries of a bucket after Build: not full, so that a few insertions do not split it at once.
  static constexpr std::size_t kBuilt = 60;
  static constexpr int kDimensions = 3;
  static constexpr std::uint32_t kNone = 0xffffffff;
  // Set in a reference to a bucket, clear in one to a node.
  static constexpr std::uint32_t kBucket = 0x80000000;

  // Bounds of x, y and count.
  struct Box {
    std::array<float, kDimensions> low;
    std::array<float, kDimensions> high;
  };
  // Entries in columns, for the vectorised bound. Those past `size` have count 0.
  struct alignas(32) Bucket {
    std::array<float, kCapacity> x{};
    std::array<float, kCapacity> y{};
    std::array<std::int32_t, kCapacity> count{};
    std::array<std::uint32_t, kCapacity> landmark{};
    std::array<std::uint32_t, kCapacity> step{};
    Box box{};
    std::int32_t size = 0;
    // The next bucket of entries with the same mean and count.
    std::uint32_t next = kNone;
  };
  // Entries whose value is below `split` are on the left.
  struct Node {
    float split = 0;
    std::uint32_t dimension = 0;
    std::uint32_t left = kNone;
    std::uint32_t right = kNone;
  };
  // A region to be searched: its distance to the query, and the greatest P_T it can hold.
  struct Region {
    float bound = 0;
    std::uint32_t reference = kNone;
    std::array<float, 2> away{};
    float ratio = 1;
    bool operator<(const Region& other) const { return bound < other.bound; }
  };
  struct Walk;

  static std::array<float, kDimensions> KeysOf(const TreeEntry& entry) {
    return {entry.x, entry.y, static_cast<float>(entry.count)};
  }
  static Box BoxOf(std::span<const TreeEntry> entries);
  static TreeEntry EntryAt(const Bucket& bucket, int index);
  static void Put(Bucket& bucket, const TreeEntry& entry);
  static std::uint32_t WidestDimension(const Box& box);
  std::uint32_t NewBucket() { return buckets_.Add(Bucket()); }
  void InsertAt(std::uint32_t* reference, const TreeEntry& entry);
  // Splits the bucket at `reference` into a node with two buckets.
  void Split(std::uint32_t* reference, std::uint32_t dimension);
  void SplitOff(std::uint32_t* reference, const TreeEntry& entry);
  void PutInChain(std::uint32_t bucket, const TreeEntry& entry);
  std::uint32_t BuildTree(std::span<TreeEntry> entries);
  std::uint32_t BuildChain(std::span<const TreeEntry> entries);
  std::uint32_t Descend(const Region& from, Walk* walk) const;
  void ScanBucket(std::uint32_t bucket, Walk* walk) const;

  ChunkedArray<Node, 256> nodes_;
  ChunkedArray<Bucket, 4> buckets_;
  std::uint32_t root_ = kNone;
};

}  // namespace homing

#endif  // HOMING_MATCHING_FINGERPRINT_TREE_H_
