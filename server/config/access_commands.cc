#include "server/config/access_commands.h"

#include <iostream>
#include <vector>

#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"
#include "server/access/identity.h"
#include "server/access/private_file.h"
#include "server/access/token_book.h"

namespace homing::server {

absl::Status RunCerts(const CertificateOrder& order) {
  HOMING_ASSIGN_OR_RETURN(const std::vector<std::string> paths, MakeCertificates(order));
  for (const std::string& path : paths) {
    std::cout << path << '\n';
  }
  return absl::OkStatus();
}

absl::Status RunToken(const TokenOrder& order, const std::string& tokens) {
  if (tokens.empty()) {
    return FieldError("tokens", "must name the file that gets the hash");
  }
  HOMING_RETURN_IF_ERROR(CheckNewIdentity(order.identity, "identity"));
  HOMING_ASSIGN_OR_RETURN(const std::string token, MakeToken());
  // The robot's file first: a token that the server does not know is harmless.
  HOMING_RETURN_IF_ERROR(WritePrivateFile(order.out, token + "\n"));
  HOMING_RETURN_IF_ERROR(AddToken(tokens, order.identity, HashToken(token)));
  std::cout << order.out << '\n' << tokens << '\n';
  return absl::OkStatus();
}

}  // namespace homing::server
