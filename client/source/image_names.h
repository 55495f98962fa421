// Order and time of image files by their names.
#ifndef CLIENT_SOURCE_IMAGE_NAMES_H_
#define CLIENT_SOURCE_IMAGE_NAMES_H_

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "client/source/frame_source.h"

namespace homing::client {

// True if the name has one of the endings, in small or capital letters.
bool HasEnding(const std::string& path, std::span<const char* const> endings);
// True if the name has the ending of a readable image format.
bool HasImageEnding(const std::string& path);

// Nanoseconds: a decimal number is seconds; a whole number of 12 digits and more is milliseconds,
// microseconds or nanoseconds by its size, a smaller one seconds. std::nullopt: no number.
std::optional<std::int64_t> ParseTime(const std::string& text);

// Numbers inside names count as numbers: 2.png before 10.png.
bool NaturalLess(const std::string& a, const std::string& b);

// Sorts as decimal numbers (0.05 before 0.1) if each name without its ending is a number and at
// least one has a point; else by NaturalLess.
void SortByName(std::vector<std::string>* paths);

// The keys of sorted paths. Times: decimal numbers are seconds; whole numbers of 12 digits and more
// are milliseconds, microseconds or nanoseconds by their size. Else the last number in each name,
// if it ascends. Else kOrder.
FrameKeys KeysOfNames(const std::vector<std::string>& paths);

}  // namespace homing::client

#endif  // CLIENT_SOURCE_IMAGE_NAMES_H_
