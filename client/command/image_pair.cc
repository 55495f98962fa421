#include "client/command/image_pair.h"

#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/source/image_folder.h"
#include "homing/base/status_macros.h"

namespace homing::client {

std::string CheckImagePair(const std::string& text) {
  const std::vector<std::string> files = absl::StrSplit(text, ',');
  const bool pair = files.size() == 2 && !files[0].empty() && !files[1].empty();
  return pair ? "" : absl::StrCat("\"", text, "\" must be two images: FIRST,SECOND");
}

absl::StatusOr<ImagePair> ReadImagePair(const std::string& text) {
  if (const std::string wrong = CheckImagePair(text); !wrong.empty()) {
    return absl::InvalidArgumentError(wrong);
  }
  const std::vector<std::string> files = absl::StrSplit(text, ',');
  ImagePair pair;
  HOMING_ASSIGN_OR_RETURN(pair.first, ReadImage(files[0]));
  HOMING_ASSIGN_OR_RETURN(pair.second, ReadImage(files[1]));
  return pair;
}

}  // namespace homing::client
