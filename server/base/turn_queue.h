// Tasks that wait, from which callers take turns.
#ifndef SERVER_BASE_TURN_QUEUE_H_
#define SERVER_BASE_TURN_QUEUE_H_

#include <cstddef>
#include <functional>
#include <list>
#include <string>
#include <unordered_map>
#include <utility>

namespace homing::server {

// The tasks of a caller stay in order. Between two tasks of one caller comes one of each other
// caller that waits, so that nobody waits for all tasks of another. Not thread-safe.
class TurnQueue {
 public:
  using Task = std::function<void()>;

  void Add(const std::string& caller, Task task) {
    const auto [found, is_new] = lines_of_.try_emplace(caller);
    if (is_new) found->second = lines_.insert(lines_.end(), Line{caller, {}});
    found->second->tasks.push_back(std::move(task));
    ++size_;
  }
  // Removes the next task; the queue must not be empty.
  Task Take() {
    Line& line = lines_.front();
    Task task = std::move(line.tasks.front());
    line.tasks.pop_front();
    --size_;
    if (line.tasks.empty()) {
      lines_of_.erase(line.caller);
      lines_.pop_front();
    } else {
      lines_.splice(lines_.end(), lines_, lines_.begin());
    }
    return task;
  }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  bool HasTaskOf(const std::string& caller) const { return lines_of_.count(caller) > 0; }

 private:
  struct Line {
    std::string caller;
    std::list<Task> tasks;
  };

  // In the order of the callers' turns; none is empty.
  std::list<Line> lines_;
  std::unordered_map<std::string, std::list<Line>::iterator> lines_of_;
  std::size_t size_ = 0;
};

}  // namespace homing::server

#endif  // SERVER_BASE_TURN_QUEUE_H_
