// The log as one JSON object a line.
#ifndef SERVER_RPC_JSON_LOG_H_
#define SERVER_RPC_JSON_LOG_H_

#include <spdlog/formatter.h>

#include <memory>

namespace homing::server {

// {"time":"2026-01-31T12:00:00.000Z","level":"info","message":"..."}; in a TraceScope also
// "trace_id" and "span_id".
std::unique_ptr<spdlog::formatter> JsonLogFormatter();

}  // namespace homing::server

#endif  // SERVER_RPC_JSON_LOG_H_
