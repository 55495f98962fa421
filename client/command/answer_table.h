// Answers as lines of comma-separated values.
#ifndef CLIENT_COMMAND_ANSWER_TABLE_H_
#define CLIENT_COMMAND_ANSWER_TABLE_H_

#include <string>

#include "homing/v1/homing_service.pb.h"

namespace homing::client {

// The words of json_line.h; empty where there is none. Without line ends.
std::string AnswerTableHead();
std::string AnswerTableLine(const v1::LocalizeResponse& answer);

}  // namespace homing::client

#endif  // CLIENT_COMMAND_ANSWER_TABLE_H_
