// What gRPC and Protobuf themselves log.
#ifndef SERVER_RPC_LIBRARY_LOG_H_
#define SERVER_RPC_LIBRARY_LOG_H_

namespace homing::server {

// Sends their lines to the server's log, a few a minute: whoever reaches the port causes them
// (failed handshakes, requests that cannot be decoded), before any token is checked. The next line
// counts those that were left out. Before gRPC is used.
void LimitLogOfLibraries();

}  // namespace homing::server

#endif  // SERVER_RPC_LIBRARY_LOG_H_
