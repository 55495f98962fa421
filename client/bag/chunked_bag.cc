#include "client/bag/chunked_bag.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"

namespace homing::client::bag {

void ChunkedBag::AddMessage(const MessagePlace& place) {
  const auto channel = channels_.find(place.channel);
  if (channel == channels_.end()) return;
  BagTopic& topic = topics_[channel->second];
  if (topic.content != Content::kOther) topic.messages.push_back(place);
}

void ChunkedBag::BeginChunk(std::uint64_t offset) {
  EndChunk(/*complete=*/true);
  open_chunk_ = static_cast<std::int64_t>(offset);
}

void ChunkedBag::AddIndex(std::uint32_t channel, std::vector<MessagePlace> places) {
  if (open_chunk_ < 0) return;
  for (MessagePlace& place : places) {
    place.chunk = open_chunk_;
    place.channel = channel;
  }
  indexes_.emplace_back(channel, std::move(places));
}

void ChunkedBag::TakeChunk(bool messages) {
  const auto offset = static_cast<std::uint64_t>(open_chunk_);
  const auto records = Chunk(offset);
  CheckPart("chunk", offset,
            records.ok() ? ScanChunk(*records, offset, messages) : records.status());
}

void ChunkedBag::CheckPart(const char* part, std::uint64_t offset, const absl::Status& status) {
  if (status.ok()) return;
  ReportDamage(absl::StrCat(file_.path(), ": the ", part, " at byte ", offset,
                            " is damaged: ", std::string(status.message())));
}

void ChunkedBag::EndScan(bool whole, std::uint64_t offset) {
  if (!whole) {
    ReportDamage(absl::StrCat(file_.path(), " ends too early; the bytes after ", offset, " of ",
                              file_.size(), " are not read"));
  }
  SortTopics();
}

void ChunkedBag::EndChunk(bool complete) {
  if (open_chunk_ < 0) return;
  const bool indexed = complete && !indexes_.empty();
  const auto unknown = [&](const auto& index) { return !channels_.contains(index.first); };
  if (!indexed) {
    TakeChunk(/*messages=*/true);
  } else if (std::any_of(indexes_.begin(), indexes_.end(), unknown)) {
    TakeChunk(/*messages=*/false);
  }
  if (indexed) {
    for (const auto& [channel, places] : indexes_) {
      for (const MessagePlace& place : places) AddMessage(place);
    }
  }
  indexes_.clear();
  open_chunk_ = -1;
}

absl::StatusOr<std::string_view> ChunkedBag::Chunk(std::uint64_t offset) {
  if (loaded_chunk_ != static_cast<std::int64_t>(offset)) {
    loaded_chunk_ = -1;
    HOMING_ASSIGN_OR_RETURN(loaded_, LoadChunk(offset));
    loaded_chunk_ = static_cast<std::int64_t>(offset);
  }
  return std::string_view(loaded_);
}

absl::StatusOr<std::string_view> ChunkedBag::BytesInChunk(const MessagePlace& place) {
  HOMING_ASSIGN_OR_RETURN(std::string_view bytes, Chunk(static_cast<std::uint64_t>(place.chunk)));
  const auto offset = static_cast<std::uint64_t>(place.offset);
  if (offset > bytes.size())
    return absl::DataLossError("the index points beyond the end of its chunk");
  return bytes.substr(offset);
}

}  // namespace homing::client::bag
