#include "homing/localization/profile_views.h"

namespace homing {

ProfileViews MakeProfileViews(const FlowField& field) {
  ProfileViews views;
  views.reserve(kPathOffsets.size());
  for (const double offset : kPathOffsets) {
    views.push_back(MakeFlowProfile(field, 1 + offset));
  }
  return views;
}

}  // namespace homing
