#include "tests/faults/power_cut.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <sstream>
#include <vector>

#include "tests/faults/disk_log.h"

namespace homing::faults {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSector = 512;

struct Change {
  DiskRecord record;
  std::string bytes;
};

// A file's bytes, whatever its name.
struct Body {
  std::string synced;
  std::vector<Change> since;
};

using Names = std::map<std::string, std::shared_ptr<Body>>;

void Put(const std::string& bytes, std::size_t from, std::size_t to, std::size_t offset,
         std::string* file) {
  file->resize(std::max(file->size(), offset + to));
  std::memcpy(file->data() + offset + from, bytes.data() + from, to - from);
}

void Apply(const Change& change, std::string* file) {
  const auto offset = static_cast<std::size_t>(change.record.offset);
  if (change.record.op == DiskOp::kTruncate) {
    file->resize(offset);
  } else {
    Put(change.bytes, 0, change.bytes.size(), offset, file);
  }
}

class Disk {
 public:
  explicit Disk(const std::map<std::string, std::string>& before) {
    for (const auto& [name, bytes] : before) {
      names_[name] = std::make_shared<Body>(Body{bytes, {}});
    }
    synced_names_ = names_;
  }

  void Do(const std::string& name, Change change) {
    switch (change.record.op) {
      case DiskOp::kCreate:
        names_[name] = std::make_shared<Body>();
        renamings_.push_back(names_);
        break;
      case DiskOp::kUnlink:
        names_.erase(name);
        renamings_.push_back(names_);
        break;
      case DiskOp::kSyncNames:
        synced_names_ = names_;
        renamings_.clear();
        break;
      case DiskOp::kSync:
        Sync(Find(name));
        break;
      default:
        Find(name)->since.push_back(std::move(change));
    }
  }

  PowerCut Cut(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    PowerCut cut;
    const std::size_t renamed = random() % (renamings_.size() + 1);
    const Names& names = renamed == 0 ? synced_names_ : renamings_[renamed - 1];
    for (const auto& [name, body] : names) cut.files[name] = Remains(*body, &random, &cut);
    return cut;
  }

 private:
  Body* Find(const std::string& name) {
    std::shared_ptr<Body>& body = names_[name];
    if (!body) body = std::make_shared<Body>();
    return body.get();
  }

  static void Sync(Body* body) {
    for (const Change& change : body->since) Apply(change, &body->synced);
    body->since.clear();
  }

  static std::string Remains(const Body& body, std::mt19937_64* random, PowerCut* cut) {
    std::string file = body.synced;
    for (const Change& change : body.since) {
      ++cut->unsynced;
      switch ((*random)() % 3) {
        case 0:
          ++cut->lost;
          break;
        case 1:
          Apply(change, &file);
          break;
        default:
          ++cut->lost;
          Tear(change, random, &file);
      }
    }
    return file;
  }

  // Some sectors of it.
  static void Tear(const Change& change, std::mt19937_64* random, std::string* file) {
    const auto offset = static_cast<std::size_t>(change.record.offset);
    for (std::size_t at = 0; at < change.bytes.size(); at += kSector) {
      const std::size_t end = std::min(at + kSector, change.bytes.size());
      if ((*random)() % 2 == 0) Put(change.bytes, at, end, offset, file);
    }
  }

  Names names_;
  Names synced_names_;
  // The names after each change that was not synced.
  std::vector<Names> renamings_;
};

}  // namespace

PowerCut CutPower(const std::map<std::string, std::string>& before, const std::string& log,
                  std::uint64_t seed) {
  Disk disk(before);
  std::size_t at = 0;
  while (at + sizeof(DiskRecord) <= log.size()) {
    Change change;
    std::memcpy(&change.record, log.data() + at, sizeof(DiskRecord));
    at += sizeof(DiskRecord);
    const auto name_size = static_cast<std::size_t>(change.record.name_size);
    const auto size = static_cast<std::size_t>(change.record.size);
    // The kill may have cut the last record.
    if (at + name_size + size > log.size()) break;
    const std::string name = log.substr(at, name_size);
    change.bytes = log.substr(at + name_size, size);
    at += name_size + size;
    disk.Do(name, std::move(change));
  }
  return disk.Cut(seed);
}

std::map<std::string, std::string> ReadFiles(const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (name.ends_with("-shm") || name.ends_with("-lock") || !entry.is_regular_file()) continue;
    const std::ifstream file(entry.path(), std::ios::binary);
    std::ostringstream bytes;
    bytes << file.rdbuf();
    files[name] = bytes.str();
  }
  return files;
}

void WriteFiles(const std::string& folder, const std::map<std::string, std::string>& files) {
  fs::remove_all(folder);
  fs::create_directories(folder);
  for (const auto& [name, bytes] : files) {
    std::ofstream(fs::path(folder) / name, std::ios::binary) << bytes;
  }
}

}  // namespace homing::faults
