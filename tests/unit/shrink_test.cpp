#include "image/shrink.hpp"

#include <gtest/gtest.h>

namespace fluxel {
namespace {

TEST(Shrink, TakesMeansOfSquaresAndOfWhatIsLeftAtTheEdges) {
  DisplayPicture picture;
  picture.width = 3;
  picture.height = 2;
  for (const int grey : {10, 20, 30, 30, 40, 51})
    for (int c = 0; c < 3; ++c) picture.rgb.push_back(static_cast<std::uint8_t>(grey + c));
  const DisplayPicture small = shrunk(picture, 2);
  EXPECT_EQ(small.width, 2);
  EXPECT_EQ(small.height, 1);
  // (10 + 20 + 30 + 40) / 4, and (30 + 51) / 2 rounded.
  EXPECT_EQ(small.rgb, (std::vector<std::uint8_t>{25, 26, 27, 41, 42, 43}));
}

TEST(Shrink, LeavesWhatIsSmall) {
  DisplayPicture picture;
  picture.width = picture.height = 1;
  picture.rgb = {1, 2, 3};
  EXPECT_EQ(shrunk(picture, 1).rgb, picture.rgb);
}

}  // namespace
}  // namespace fluxel
