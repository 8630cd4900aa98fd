// Films by the number of their frames: what they hold, and what of them a part is.
#include "render/frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace render {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Stage stage(std::vector<Shot> shots) {
  Stage s;
  s.cameras.emplace_back().name = "side";
  s.shots = std::move(shots);
  return s;
}

std::vector<int> numbers(const Film& film) {
  std::vector<int> out;
  for (int i = 0; i < film.size(); ++i) out.push_back(film.number(i));
  return out;
}

TEST(FramesOfAFilm, TakeNoMemoryHoweverManyTheyAre) {
  const Film film(stage({{"side", 0, 0.3, 1, 0}, {"side", 0.01, 0.04, 2.5e-8, 0}}), 0.3, 30);
  // 9 of the first shot, and 0.03 s at 2.5e-8, which are 1.2e6 s of film
  ASSERT_EQ(film.size(), 9 + 36'000'000);
  // what a double leaves of 1e6 s of film, 1e-10 s, are 2.5e-18 s of the run
  EXPECT_NEAR(film[9 + 18'000'000].time, 0.025, 1e-15);
  EXPECT_LT(film[film.size() - 1].time, 0.04);
  const Film part = film.between(0.02, 0.025);
  EXPECT_EQ(part.number(0), 9 + 12'000'000 - 1) << "times are compared to 1e-9 s, which are 1.2 frames here";
}

TEST(FramesOfAFilm, BeginWhereTheLastShotsEndsAndNotAtAFrame) {
  // the first shot ends a quarter of a frame after its third frame: the next begins with its own clock at 0.75 of a frame
  const Film film(stage({{"side", 0, 0.225, 1, 0}, {"side", 1, 2, 0.5, 0}}), 2, 10);
  EXPECT_EQ(film[2].shot, 0);
  EXPECT_EQ(film[3].shot, 1);
  EXPECT_NEAR(film[3].time, 1 + 0.5 * 0.075, 1e-12);
  EXPECT_EQ(film.size(), 23) << "2.225 s of film";
}

TEST(FramesOfAFilm, MoreThanCanBeCountedAreRefusedByTheNameOfTheShot) {
  for (const double speed : {1e-12, 1e-320}) {
    try {
      Film(stage({{"side", 0, 1, 1, 0}, {"side", 0, 1, speed, 0}}), 1, 30);
      ADD_FAILURE() << speed;
    } catch (const FilmTooLong& error) {
      EXPECT_THAT(error.what(), HasSubstr("shot.1 (camera side, speed 1e-"));
    }
  }
  // each of these shots fits
  EXPECT_THROW(Film(stage({{"side", 0, 1, 5e-8, 0}, {"side", 0, 1, 5e-8, 0}}), 1, 30), FilmTooLong);
  EXPECT_EQ(Film(stage({{"side", 0, 1, 5e-8, 0}}), 1, 30).size(), 600'000'000);
}

TEST(FramesOfAFilm, OfARunThatEndedAtOnceAreOne) {
  const Film film(stage({}), 0, 30);
  ASSERT_EQ(film.size(), 1);
  EXPECT_EQ(film[0].time, 0);
  EXPECT_EQ(Film(stage({}), 0.1, 30).size(), 3);
}

TEST(PartOfAFilm, HasEachFrameOnceInOrderWithItsNumber) {
  const Film film(stage({{"side", 0, 1, 1, 0}, {"side", 0.5, 1, 0.5, 0}}), 1, 10);
  ASSERT_EQ(film.size(), 20);
  const Film part = film.part({{17, 99}, {3, 5}, {5, 6}, {-4, 0}, {4, 4}, {9, 10}});
  EXPECT_THAT(numbers(part), ElementsAre(0, 3, 4, 5, 6, 9, 10, 17, 18, 19));
  for (int i = 0; i < part.size(); ++i) EXPECT_EQ(part[i].time, film[part.number(i)].time) << i;
  EXPECT_TRUE(part.holds(6));
  for (const int other : {-1, 1, 7, 16, 20}) EXPECT_FALSE(part.holds(other)) << other;
  // a part of a part: of both shots what lies between the times
  EXPECT_THAT(numbers(part.between(0.5, 0.65)), ElementsAre(5, 6, 10));
  EXPECT_THAT(numbers(part.part({{6, 17}})), ElementsAre(6, 9, 10, 17));
  EXPECT_TRUE(part.part({{11, 16}}).empty());
  const std::vector<FrameInterval> shots = part.shots();
  ASSERT_EQ(shots.size(), 2u);
  EXPECT_EQ(part.number(shots[0].last), 9);
  EXPECT_EQ(part.number(shots[1].first), 10);
}

}  // namespace
}  // namespace render
