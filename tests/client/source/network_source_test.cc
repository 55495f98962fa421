// A camera that sends JPEG images over HTTP, as most network cameras can.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <thread>
#include <vector>

#include "client/source/frame_source.h"
#include "tests/support/status_matchers.h"

namespace homing::client {
namespace {

using ::testing::HasSubstr;

#ifdef HOMING_OPENCV_READERS
std::string Jpeg(int brightness) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", cv::Mat(48, 64, CV_8UC1, cv::Scalar(brightness)), bytes);
  return {bytes.begin(), bytes.end()};
}

// Answers each request with `images` in a multipart stream, then ends.
class HttpCamera {
 public:
  explicit HttpCamera(int images) : images_(images) {
    socket_ = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(::listen(socket_, 4), 0);
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { Serve(); });
  }
  ~HttpCamera() {
    ::shutdown(socket_, SHUT_RDWR);
    thread_.join();
    ::close(socket_);
  }

  std::string Address(const std::string& user = "") const {
    return "http://" + user + "127.0.0.1:" + std::to_string(port_) + "/video";
  }

 private:
  void Serve() {
    while (true) {
      const int link = ::accept(socket_, nullptr, nullptr);
      if (link < 0) return;
      char request[4096];
      if (::recv(link, request, sizeof(request), 0) > 0) Answer(link);
      ::close(link);
    }
  }

  void Answer(int link) const {
    std::string text =
        "HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace;boundary=frame\r\n\r\n";
    for (int i = 0; i < images_; ++i) {
      const std::string image = Jpeg(i < 5 ? 10 * i : 200);
      text +=
          "--frame\r\nContent-Type: image/jpeg\r\nContent-Length: " + std::to_string(image.size()) +
          "\r\n\r\n" + image + "\r\n";
    }
    for (std::size_t sent = 0; sent < text.size();) {
      const ssize_t part = ::send(link, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
      if (part <= 0) return;
      sent += static_cast<std::size_t>(part);
    }
  }

  int images_;
  int socket_ = -1;
  int port_ = 0;
  std::thread thread_;
};

TEST(NetworkSourceTest, ReadsAnHttpCamera) {
  const HttpCamera camera(20);
  const auto source = OpenFrameSource(camera.Address(), Side::kLeft);
  ASSERT_THAT(source, IsOk());
  EXPECT_TRUE((*source)->live());
  EXPECT_FALSE((*source)->Seek(0));
  for (int i = 0; i < 5; ++i) {
    const auto frame = (*source)->Next();
    ASSERT_THAT(frame, IsOk());
    ASSERT_TRUE(*frame);
    EXPECT_EQ((**frame).width, 64);
    EXPECT_NEAR(static_cast<unsigned char>((**frame).data[0]), 10 * i, 3);
    EXPECT_GT((**frame).capture_time_ns, 0);
  }
}

TEST(NetworkSourceTest, ACameraThatEndsIsAnErrorWithoutThePassword) {
  const HttpCamera camera(6);
  const auto source = OpenFrameSource(camera.Address("user:secret@"), Side::kLeft);
  ASSERT_THAT(source, IsOk());
  absl::Status status;
  for (int i = 0; i < 10 && status.ok(); ++i) status = (*source)->Next().status();
  EXPECT_THAT(status, StatusIs(absl::StatusCode::kDataLoss, HasSubstr("no more frames")));
  EXPECT_EQ(std::string(status.message()).find("secret"), std::string::npos);
}

TEST(NetworkSourceTest, NoCameraThere) {
  const auto status = OpenFrameSource("http://user:secret@127.0.0.1:9/video", Side::kLeft).status();
  EXPECT_THAT(status, StatusIs(absl::StatusCode::kNotFound, HasSubstr("http://127.0.0.1:9/video")));
}
#endif

TEST(NetworkSourceTest, Addresses) {
  EXPECT_TRUE(IsNetworkSource("rtsp://camera/stream"));
  EXPECT_TRUE(IsNetworkSource("HTTPS://camera/video"));
  EXPECT_FALSE(IsNetworkSource("/data/rtsp"));
  EXPECT_FALSE(IsNetworkSource("http"));
}

TEST(NetworkSourceTest, ANumberIsACamera) {
  EXPECT_THAT(OpenFrameSource("987", Side::kLeft).status(),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("/dev/video987")));
}

}  // namespace
}  // namespace homing::client
