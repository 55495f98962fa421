#include "client/command/growing_file.h"

#include <cerrno>

#include "client/file/output_file.h"
#include "homing/base/status_macros.h"

namespace homing::client {

absl::StatusOr<std::ofstream> OpenGrowingFile(const std::string& path,
                                              const std::stop_token& stop) {
  HOMING_RETURN_IF_ERROR(CheckWritable(path));
  HOMING_ASSIGN_OR_RETURN(const HeldPipe pipe, AwaitReader(path, stop));
  errno = 0;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  if (!file) return CannotWrite(path, errno);
  return file;
}

}  // namespace homing::client
