// Memory that many users share up to a limit.
#ifndef SERVER_BASE_MEMORY_BUDGET_H_
#define SERVER_BASE_MEMORY_BUDGET_H_

#include <atomic>
#include <cstdint>

namespace homing::server {

// Thread-safe.
class MemoryBudget {
 public:
  // `most` bytes; 0: no limit.
  explicit MemoryBudget(std::int64_t most) : most_(most) {}

  std::int64_t most() const { return most_; }
  std::int64_t used() const { return used_; }

  // One user's part, given back at the end. Not thread-safe; the budget must outlive it.
  class Share {
   public:
    explicit Share(MemoryBudget* budget) : budget_(budget) {}
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;
    ~Share() { Set(0); }

    // False, and no change: all users together would have more than the limit.
    bool TrySet(std::int64_t bytes) {
      const std::int64_t used = budget_->used_ += bytes - bytes_;
      if (bytes > bytes_ && budget_->most_ > 0 && used > budget_->most_) {
        budget_->used_ -= bytes - bytes_;
        return false;
      }
      bytes_ = bytes;
      return true;
    }
    // Takes the memory whatever the limit.
    void Set(std::int64_t bytes) {
      budget_->used_ += bytes - bytes_;
      bytes_ = bytes;
    }

   private:
    MemoryBudget* const budget_;
    std::int64_t bytes_ = 0;
  };

 private:
  const std::int64_t most_;
  std::atomic<std::int64_t> used_ = 0;
};

}  // namespace homing::server

#endif  // SERVER_BASE_MEMORY_BUDGET_H_
