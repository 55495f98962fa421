// Training, reading and choosing deviation models.
#include "tests/server/server_fixture.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

class ModelServiceTest : public ServerTest {
 protected:
  grpc::Status Train(const v1::TrainDeviationModelRequest& request,
                     v1::TrainDeviationModelResponse* response) {
    grpc::ClientContext context;
    return models_->TrainDeviationModel(&context, request, response);
  }
};

TEST_F(ModelServiceTest, TheBuiltInModelIsThePapers) {
  grpc::ClientContext context;
  v1::GetDeviationModelRequest request;
  request.set_name("deviationModels/default");
  v1::DeviationModel model;
  ASSERT_THAT(models_->GetDeviationModel(&context, request, &model), IsGrpcOk());
  EXPECT_EQ(model.mu(), 2.24);
  EXPECT_EQ(model.sigma(), 0.86);
}

TEST_F(ModelServiceTest, ATrainedModelIsKeptAndChosenByAJourney) {
  v1::TrainDeviationModelRequest request;
  request.set_model_id("wide");
  request.mutable_settings()->set_width(640);
  request.mutable_settings()->set_height(480);
  request.mutable_settings()->set_focal_px(500);
  request.set_include_deviations(true);
  v1::TrainDeviationModelResponse trained;
  ASSERT_THAT(Train(request, &trained), IsGrpcOk());
  EXPECT_EQ(trained.model().name(), "deviationModels/wide");
  EXPECT_EQ(trained.deviations_px_size(), 1000);
  v1::TrainDeviationModelResponse again;
  ASSERT_THAT(Train(request, &again), IsGrpcOk());
  EXPECT_EQ(again.model().SerializeAsString(), trained.model().SerializeAsString());
  request.mutable_settings()->set_seed(99);
  EXPECT_THAT(Train(request, &again),
              GrpcStatusIs(grpc::StatusCode::ALREADY_EXISTS, HasSubstr("wide")));

  grpc::ClientContext list_context;
  v1::ListDeviationModelsResponse list;
  ASSERT_THAT(models_->ListDeviationModels(&list_context, {}, &list), IsGrpcOk());
  ASSERT_EQ(list.models_size(), 2);
  EXPECT_EQ(list.models(0).name(), "deviationModels/default");
  EXPECT_EQ(list.models(1).SerializeAsString(), trained.model().SerializeAsString());

  grpc::ClientContext create_context;
  v1::CreateJourneyRequest create;
  create.set_parent("robots/r");
  create.set_journey_id("out");
  create.mutable_journey()->mutable_settings()->set_deviation_model("deviationModels/wide");
  v1::Journey made;
  ASSERT_THAT(journeys_->CreateJourney(&create_context, create, &made), IsGrpcOk());
  EXPECT_EQ(made.settings().deviation_model(), "deviationModels/wide");
}

TEST_F(ModelServiceTest, WrongTrainingIsRefused) {
  v1::TrainDeviationModelRequest request;
  v1::TrainDeviationModelResponse response;
  request.set_model_id("default");
  EXPECT_THAT(Train(request, &response), GrpcStatusIs(kInvalid, HasSubstr("built in")));
  request.set_model_id("a b");
  EXPECT_EQ(BadFieldOf(Train(request, &response)), "model_id");
  request.set_model_id("m");
  request.mutable_settings()->set_observations(2'000'000'000);
  EXPECT_THAT(Train(request, &response), GrpcStatusIs(kInvalid, HasSubstr("2000000000")));
  EXPECT_EQ(BadFieldOf(Train(request, &response)), "settings.observations");
  grpc::ClientContext context;
  v1::GetDeviationModelRequest get;
  get.set_name("deviationModels/none");
  v1::DeviationModel model;
  EXPECT_THAT(models_->GetDeviationModel(&context, get, &model),
              GrpcStatusIs(grpc::StatusCode::NOT_FOUND, HasSubstr("deviationModels/none")));
}

}  // namespace
}  // namespace homing::server
