// Log lines that anyone can cause: those of gRPC and Protobuf themselves, and of callers without an
// identity.
#ifndef SERVER_RPC_LIBRARY_LOG_H_
#define SERVER_RPC_LIBRARY_LOG_H_

#include <string>

namespace homing::server {

// Sends their lines to the server's log, a few a minute: anyone that reaches the port can cause
// them (failed handshakes, requests that cannot be decoded) before a token is checked. The next
// line counts the omitted ones. Call it before gRPC is used.
void LimitLogOfLibraries();

// Writes a line that a caller without an identity causes; as few a minute.
void LogOfStranger(const std::string& text);

}  // namespace homing::server

#endif  // SERVER_RPC_LIBRARY_LOG_H_
