// Gauges whose values are read from the running server at each scrape.
#ifndef SERVER_CORE_GAUGES_H_
#define SERVER_CORE_GAUGES_H_

#include "server/config/server_options.h"
#include "server/rpc/service_core.h"

namespace homing::server {

// They stay until core->metrics->RemoveGauges().
void AddCoreGauges(const ServerOptions& options, ServiceCore* core);

}  // namespace homing::server

#endif  // SERVER_CORE_GAUGES_H_
