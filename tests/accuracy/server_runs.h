// Drives recorded and localised through a running server, as a robot does it with the client
// library.
#ifndef TESTS_ACCURACY_SERVER_RUNS_H_
#define TESTS_ACCURACY_SERVER_RUNS_H_

#include <cstddef>
#include <functional>
#include <string>

#include "client/connection.h"
#include "client/homing_client.h"
#include "homing/flow/observation.h"

namespace homing::accuracy {

// Numbered from 0; made when asked for.
struct Observations {
  std::size_t count = 0;
  std::function<ObservedFlow(std::size_t)> flow;

  Observation At(std::size_t sequence) const;
};

// Each ends the program with the reason if the server refuses. Creates, records and finishes.
void RecordOnServer(const client::Connection& server, const std::string& journey,
                    const Observations& observations);
void LocalizeOnServer(const client::Connection& server, const client::LocalizingOptions& options,
                      const Observations& observations,
                      const std::function<void(const v1::LocalizeResponse&)>& take);
void DeleteOnServer(const client::Connection& server, const std::string& journey);

}  // namespace homing::accuracy

#endif  // TESTS_ACCURACY_SERVER_RUNS_H_
