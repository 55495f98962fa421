// The path of a field in a request, for BadRequest.
#ifndef SERVER_RPC_FIELD_PATH_H_
#define SERVER_RPC_FIELD_PATH_H_

#include <google/protobuf/descriptor.h>

#include <string>

namespace homing::server {

// Makes a path of `request` of the beginning of an error's message. Inner functions name a field
// by their own words, so that the parts may begin in the middle ("frame.data has ...") or come
// twice
// ("flow: flow.cell_px 0 ..."): missing parts are found in the message's descriptor, words that are
// no field are dropped. Empty: no field is named.
std::string FieldPath(const std::string& message, const google::protobuf::Descriptor& request);

}  // namespace homing::server

#endif  // SERVER_RPC_FIELD_PATH_H_
