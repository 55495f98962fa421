#include "client/source/opencv_readers.h"

#include <dlfcn.h>

#include "absl/strings/str_cat.h"

namespace homing::client {
namespace {

// The program's run path names the folders.
constexpr char kModule[] = "homing_opencv.so";

absl::StatusOr<const OpenCvReaders*> Load() {
  void* const module = ::dlopen(kModule, RTLD_NOW | RTLD_LOCAL);
  void* const entry = module == nullptr ? nullptr : ::dlsym(module, "HomingOpenCvReaders");
  if (entry == nullptr) {
    return absl::UnimplementedError(
        absl::StrCat("videos, cameras and images other than JPEG and PNG need ", kModule,
                     ", which cannot be loaded: ", ::dlerror()));
  }
  return reinterpret_cast<const OpenCvReaders* (*)()>(entry)();
}

}  // namespace

absl::StatusOr<const OpenCvReaders*> LoadOpenCvReaders() {
  static const absl::StatusOr<const OpenCvReaders*> readers = Load();
  return readers;
}

}  // namespace homing::client
