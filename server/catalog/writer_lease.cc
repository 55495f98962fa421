#include "server/catalog/writer_lease.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "server/base/error_reason.h"

namespace homing::server {
namespace {

constexpr std::size_t kMaxWriterIdLength = 128;

std::string_view ProgramOf(std::string_view writer_id) {
  return writer_id.substr(0, writer_id.find('#'));
}

}  // namespace

absl::Status CheckWriterId(const std::string& writer_id, const std::string& field) {
  const bool printable =
      std::all_of(writer_id.begin(), writer_id.end(), [](char c) { return c >= ' ' && c <= '~'; });
  if (writer_id.size() > kMaxWriterIdLength || !printable) {
    return TextMustBe(field, writer_id, "at most 128 printable ASCII characters");
  }
  return absl::OkStatus();
}

absl::Status WriterLease::CheckFree(const std::string& writer_id, TimePoint now) const {
  if (!active_ || ProgramOf(writer_id) == ProgramOf(writer_id_) || now - renewed_ >= kDuration) {
    return absl::OkStatus();
  }
  const auto left =
      std::chrono::duration_cast<std::chrono::milliseconds>(kDuration - (now - renewed_)).count();
  return WithReason(absl::AbortedError(absl::StrCat(
                        "writer_id: \"", writer_id,
                        "\" must wait: another writer holds the journey, and its lease of ",
                        kDuration.count(), " s ends in ", left, " ms")),
                    {"WRITER_LEASE_HELD", {{"lease_left_ms", absl::StrCat(left)}}});
}

std::uint64_t WriterLease::Take(const std::string& writer_id, TimePoint now, Evict evict,
                                Evict* previous) {
  *previous = std::exchange(evict_, std::move(evict));
  writer_id_ = writer_id;
  active_ = true;
  open_ = true;
  renewed_ = now;
  return ++claim_;
}

absl::Status WriterLease::CheckNoStream(TimePoint now) const {
  if (!active_ || !open_ || now - renewed_ >= kDuration) {
    return absl::OkStatus();
  }
  return WithReason(absl::AbortedError("a stream records the journey; set force to end it"),
                    {"WRITER_LEASE_HELD", {}});
}

WriterLease::Evict WriterLease::Release() {
  active_ = false;
  return std::exchange(evict_, nullptr);
}

}  // namespace homing::server
