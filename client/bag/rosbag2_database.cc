#include "client/bag/rosbag2_database.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <filesystem>
#include <map>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "client/bag/bag_file.h"
#include "client/bag/byte_reader.h"
#include "client/bag/decompression.h"
#include "homing/base/status_macros.h"

namespace homing::client::bag {
namespace {

constexpr char kZstdMagic[] = "\x28\xb5\x2f\xfd";
// Size of the header of SQLite's files, and the offset of the number of pages in it.
constexpr std::uint64_t kHeadBytes = 100;
constexpr std::uint64_t kPageCountOffset = 28;

// Opens the file as immutable: SQLite then writes nothing beside it, which a read-only folder would
// not allow. Opens it normally while a log beside it shows that another program writes to it.
std::string UriOf(const std::string& path) {
  std::error_code error;
  const bool in_use = std::filesystem::exists(path + "-wal", error) ||
                      std::filesystem::exists(path + "-journal", error);
  const std::string whole = std::filesystem::absolute(path, error).string();
  return absl::StrCat("file://",
                      absl::StrReplaceAll(whole, {{"%", "%25"}, {"?", "%3f"}, {"#", "%23"}}),
                      in_use ? "" : "?immutable=1");
}

class Rosbag2Database : public Bag {
 public:
  // Throws SQLite::Exception.
  Rosbag2Database(const std::string& path, const BagLimits& limits)
      : path_(path),
        limits_(limits),
        database_(UriOf(path), SQLite::OPEN_READONLY | SQLite::OPEN_URI) {
    sqlite3_limit(database_.getHandle(), SQLITE_LIMIT_LENGTH, static_cast<int>(limits.max_chunk));
    // The file is foreign: its triggers and views must not run functions. With writable_schema,
    // SQLite also opens a file whose end is missing; it is opened for reading only.
    database_.exec(
        "PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON; PRAGMA writable_schema = ON");
  }

  absl::Status Scan();
  absl::StatusOr<std::string> Read(const MessagePlace& place) override;

 private:
  // False for a view, whose query could run for ever.
  bool IsTable(const std::string& name);
  // Reports a file that has fewer pages than its head says, or ends within a page.
  absl::Status CheckPages();
  void ScanTopics();
  void ScanMessages();

  std::string path_;
  BagLimits limits_;
  SQLite::Database database_;
  // The table's key to the index in topics_, while the database is scanned.
  std::map<std::int64_t, std::size_t> keys_;
};

bool Rosbag2Database::IsTable(const std::string& name) {
  SQLite::Statement query(database_,
                          "SELECT sql FROM sqlite_master WHERE type = 'table' AND name = ?");
  query.bind(1, name);
  return query.executeStep() &&
         !absl::StartsWithIgnoreCase(query.getColumn(0).getString(), "CREATE VIRTUAL");
}

absl::Status Rosbag2Database::CheckPages() {
  HOMING_ASSIGN_OR_RETURN(const BagFile file, BagFile::Open(path_));
  HOMING_ASSIGN_OR_RETURN(const std::string head, file.ReadUpTo(0, kHeadBytes));
  SQLite::Statement query(database_, "PRAGMA page_size");
  const auto page = query.executeStep() ? query.getColumn(0).getUInt() : 0;
  ByteReader reader(head);
  reader.set_big_endian(true);
  reader.Bytes(kPageCountOffset);
  const std::uint64_t whole = std::uint64_t{reader.Take<std::uint32_t>()} * page;
  if (page > 0 && (file.size() < whole || file.size() % page != 0)) {
    ReportDamage(absl::StrCat(path_, " ends too early: it has ", file.size(), " bytes of ", whole,
                              "; the missing part is not read"));
  }
  return absl::OkStatus();
}

void Rosbag2Database::ScanTopics() {
  SQLite::Statement query(database_, "SELECT id, name, type, serialization_format FROM topics");
  while (query.executeStep()) {
    const bool cdr = query.getColumn(3).getString() == "cdr";
    keys_[query.getColumn(0).getInt64()] =
        AddTopic(query.getColumn(1).getString(), query.getColumn(2).getString(),
                 cdr ? Wire::kCdr : Wire::kOther);
  }
}

void Rosbag2Database::ScanMessages() {
  SQLite::Statement query(database_, "SELECT id, topic_id, timestamp FROM messages");
  while (query.executeStep()) {
    const auto key = keys_.find(query.getColumn(1).getInt64());
    if (key == keys_.end()) continue;
    BagTopic& topic = topics_[key->second];
    if (topic.content == Content::kOther) continue;
    MessagePlace place;
    place.offset = query.getColumn(0).getInt64();
    place.time_ns = query.getColumn(2).getInt64();
    topic.messages.push_back(place);
  }
}

absl::Status Rosbag2Database::Scan() {
  try {
    if (!IsTable("topics") || !IsTable("messages")) {
      return absl::InvalidArgumentError(
          absl::StrCat(path_, " is not a database of rosbag2: it has no topics or no messages"));
    }
    HOMING_RETURN_IF_ERROR(CheckPages());
    ScanTopics();
  } catch (const SQLite::Exception& error) {
    return absl::InvalidArgumentError(absl::StrCat(path_, " is damaged: ", error.what()));
  }
  try {
    ScanMessages();
  } catch (const SQLite::Exception& error) {
    ReportDamage(absl::StrCat(path_, " is damaged: ", error.what()));
  }
  SortTopics();
  return absl::OkStatus();
}

absl::StatusOr<std::string> Rosbag2Database::Read(const MessagePlace& place) {
  std::string bytes;
  try {
    SQLite::Statement query(database_, "SELECT data FROM messages WHERE id = ?");
    query.bind(1, place.offset);
    if (!query.executeStep()) return absl::DataLossError("the message is missing");
    bytes = query.getColumn(0).getString();
  } catch (const SQLite::Exception& error) {
    return absl::DataLossError(absl::StrCat("the message is damaged: ", error.what()));
  }
  // rosbag2 can compress each message; no message of ROS begins like that.
  if (!absl::StartsWith(bytes, kZstdMagic)) return bytes;
  return DecompressZstd(bytes, limits_.max_chunk);
}

}  // namespace

absl::StatusOr<std::unique_ptr<Bag>> OpenRosbag2Database(const std::string& path,
                                                         const BagLimits& limits) {
  try {
    auto bag = std::make_unique<Rosbag2Database>(path, limits);
    HOMING_RETURN_IF_ERROR(bag->Scan());
    return bag;
  } catch (const SQLite::Exception& error) {
    return absl::InvalidArgumentError(absl::StrCat(path, ": ", error.what()));
  }
}

}  // namespace homing::client::bag
