// A bag whose messages lie in chunks that may be compressed, each with an index of its messages
// behind it. The file is scanned once from record to record; chunks are decompressed only where
// their index is missing or names an unknown channel. So files without a summary, and those that
// end too early, are read in the same way as whole ones.
#ifndef CLIENT_BAG_CHUNKED_BAG_H_
#define CLIENT_BAG_CHUNKED_BAG_H_

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "client/bag/bag.h"
#include "client/bag/bag_file.h"

namespace homing::client::bag {

// Not thread-safe.
class ChunkedBag : public Bag {
 protected:
  ChunkedBag(BagFile file, const BagLimits& limits) : file_(std::move(file)), limits_(limits) {}

  // Implemented by the format. The decompressed content of a chunk.
  virtual absl::StatusOr<std::string> LoadChunk(std::uint64_t offset) = 0;
  // Adds the channels of a chunk's records, and its messages if `messages` is set.
  virtual absl::Status ScanChunk(std::string_view records, std::uint64_t chunk, bool messages) = 0;

  // A message of an unknown or an uninteresting channel is left out.
  void AddMessage(const MessagePlace& place);
  // Call it for channels of unknown content, too.
  void SetChannel(std::uint32_t channel, std::size_t topic) { channels_[channel] = topic; }

  // While scanning the file: a chunk record, index records behind it, any other record or the end.
  void BeginChunk(std::uint64_t offset);
  void AddIndex(std::uint32_t channel, std::vector<MessagePlace> places);
  // `complete`: the file continues after the chunk's indexes.
  void EndChunk(bool complete);
  // Reports the `part` ("record") at `offset` as damaged unless `status` is OK.
  void CheckPart(const char* part, std::uint64_t offset, const absl::Status& status);
  // Call it at the end of the scan. `whole`: the file is complete; else it ends at `offset`.
  void EndScan(bool whole, std::uint64_t offset);

  // The chunk that was used last stays in memory. The view lasts until the next call.
  absl::StatusOr<std::string_view> Chunk(std::uint64_t offset);
  // The bytes of a message's chunk from the message on. DATA_LOSS.
  absl::StatusOr<std::string_view> BytesInChunk(const MessagePlace& place);

  BagFile file_;
  BagLimits limits_;

 private:
  void TakeChunk(bool messages);

  // Channel to index in topics_ while the file is scanned.
  std::map<std::uint32_t, std::size_t> channels_;
  std::int64_t open_chunk_ = -1;
  std::vector<std::pair<std::uint32_t, std::vector<MessagePlace>>> indexes_;
  std::int64_t loaded_chunk_ = -1;
  std::string loaded_;
};

}  // namespace homing::client::bag

#endif  // CLIENT_BAG_CHUNKED_BAG_H_
