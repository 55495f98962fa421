// The one form of an error about a field: "FIELD: VALUE must be RANGE UNIT". The field's name is
// also a payload of the status, so that no caller has to read it out of the text.
#ifndef HOMING_BASE_FIELD_ERROR_H_
#define HOMING_BASE_FIELD_ERROR_H_

#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"

namespace homing {

// The payload that holds the field's name.
inline constexpr char kFieldPayload[] = "homing/field";

// INVALID_ARGUMENT "FIELD: PROBLEM".
inline absl::Status FieldError(const std::string& field, const std::string& problem) {
  absl::Status status = absl::InvalidArgumentError(absl::StrCat(field, ": ", problem));
  status.SetPayload(kFieldPayload, absl::Cord(field));
  return status;
}

// INVALID_ARGUMENT "FIELD: VALUE must be RULE". `rule` ends with the unit.
template <typename T>
absl::Status MustBe(const std::string& field, const T& value, const std::string& rule) {
  return FieldError(field, absl::StrCat(value, " must be ", rule));
}

// The same with a text as the value: quoted, and cut at 200 bytes.
inline absl::Status TextMustBe(const std::string& field, const std::string& value,
                               const std::string& rule) {
  return MustBe(field, absl::StrCat("\"", value.substr(0, 200), "\""), rule);
}

// The name of the field that `status` is about, if it has one.
inline std::optional<std::string> FieldOf(const absl::Status& status) {
  const auto field = status.GetPayload(kFieldPayload);
  return field ? std::optional(std::string(*field)) : std::nullopt;
}

// The same error, about a field of `holder`: "FIELD: ..." becomes "HOLDER.FIELD: ...", and a text
// without a field becomes "HOLDER: ...". All payloads stay.
inline absl::Status Within(const std::string& holder, const absl::Status& status) {
  if (status.ok()) {
    return status;
  }
  const std::optional<std::string> field = FieldOf(status);
  absl::Status longer(status.code(),
                      absl::StrCat(holder, field ? "." : ": ", std::string(status.message())));
  status.ForEachPayload(
      [&](absl::string_view url, const absl::Cord& value) { longer.SetPayload(url, value); });
  longer.SetPayload(kFieldPayload, absl::Cord(field ? absl::StrCat(holder, ".", *field) : holder));
  return longer;
}

// The same error with the field's beginning `from` replaced by `to`: "FROM.REST: ..." becomes
// "TO.REST: ...". An error about another field, or none, stays. All payloads stay.
inline absl::Status Renamed(const absl::Status& status, const std::string& from,
                            const std::string& to) {
  const std::string field = FieldOf(status).value_or("");
  const std::string message(status.message());
  const bool begins = field.compare(0, from.size(), from) == 0 &&
                      (field.size() == from.size() || field[from.size()] == '.');
  if (status.ok() || !begins || message.compare(0, from.size(), from) != 0) return status;
  absl::Status renamed(status.code(), absl::StrCat(to, message.substr(from.size())));
  status.ForEachPayload(
      [&](absl::string_view url, const absl::Cord& value) { renamed.SetPayload(url, value); });
  renamed.SetPayload(kFieldPayload, absl::Cord(absl::StrCat(to, field.substr(from.size()))));
  return renamed;
}

}  // namespace homing

#endif  // HOMING_BASE_FIELD_ERROR_H_
