// The log lines of gRPC and Protobuf themselves.
#ifndef SERVER_RPC_LIBRARY_LOG_H_
#define SERVER_RPC_LIBRARY_LOG_H_

namespace homing::server {

// Sends their lines to the server's log, a few a minute: anyone that reaches the port can cause
// them (failed handshakes, requests that cannot be decoded) before a token is checked. The next
// line counts the omitted ones. Call it before gRPC is used.
void LimitLogOfLibraries();

}  // namespace homing::server

#endif  // SERVER_RPC_LIBRARY_LOG_H_
