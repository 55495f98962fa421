#include "homing/localization/route_membership.h"

#include <gtest/gtest.h>

namespace homing {
namespace {

TEST(RouteMembershipTest, StartsAtThePrior) {
  EXPECT_NEAR(RouteMembership(0.2).OnRoute(), 0.8, 1e-9);
}

TEST(RouteMembershipTest, LeavingTakesThatFractionOff) {
  RouteMembership membership(0.2);
  membership.Leave(0.5);
  EXPECT_NEAR(membership.OnRoute(), 0.4, 1e-9);
  membership.Leave(0);
  EXPECT_NEAR(membership.OnRoute(), 0.4, 1e-9);
}

TEST(RouteMembershipTest, HoweverLongOffTheRouteSomeEvidenceBringsItBack) {
  RouteMembership membership(0.2);
  for (int i = 0; i < 1000; ++i) membership.Add(-5);
  membership.Leave(1);
  EXPECT_LT(membership.OnRoute(), 0.1);
  for (int i = 0; i < 4; ++i) {
    membership.Add(1);
    membership.Fit(5);
  }
  EXPECT_GT(membership.OnRoute(), 0.5);
}

TEST(RouteMembershipTest, DroppedEvidenceLeavesEvenOddsAtMost) {
  RouteMembership membership(0.2);
  membership.Add(5);
  membership.DropEvidence();
  EXPECT_NEAR(membership.OnRoute(), 0.5, 1e-9);
  membership.Add(-2);
  membership.DropEvidence();
  EXPECT_LT(membership.OnRoute(), 0.2);
}

TEST(RouteMembershipTest, WhatStaysPossibleIsReportedButNoMatch) {
  RouteMembership membership(0.2);
  membership.Add(-5);
  membership.StayPossible();
  EXPECT_GT(membership.OnRoute(), 0.5);
  EXPECT_LT(membership.OnRoute(), 0.6);
  membership.Add(5);
  const double more = membership.OnRoute();
  membership.StayPossible();
  EXPECT_EQ(membership.OnRoute(), more);
}

TEST(RouteMembershipTest, ItIsSureByTheEvidenceAlone) {
  RouteMembership membership(0.2);
  EXPECT_FALSE(membership.IsSure());
  membership.Add(3);
  EXPECT_TRUE(membership.IsSure());
  membership.Leave(0.5);
  EXPECT_TRUE(membership.IsSure());
  membership.DropEvidence();
  EXPECT_FALSE(membership.IsSure());
}

TEST(RouteMembershipTest, WhatHasLeftIsForgottenWhereTheRestFits) {
  RouteMembership membership(0.2);
  membership.Leave(0.5);
  membership.Fit(1);
  EXPECT_NEAR(membership.OnRoute(), 0.4, 1e-9);
  for (int i = 0; i < 10; ++i) membership.Fit(3);
  EXPECT_NEAR(membership.OnRoute(), 0.8, 1e-3);
}

TEST(RouteMembershipTest, WhatHasLeftStaysWhereTheRestDoesNotFit) {
  RouteMembership membership(0.2);
  membership.Leave(0.2);
  for (int i = 0; i < 10; ++i) membership.Fit(0.5);
  EXPECT_LT(membership.OnRoute(), 0.1);
}

}  // namespace
}  // namespace homing
