// What `check` sees before a run, and what a run says of itself: overlaps, misses, throws that are not over, empty pictures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"
#include "tests/cli/slip.h"

namespace cli_tests {
namespace {

using testing::HasSubstr;

TEST(Check, ForeseesWhatARunWouldTellTooLate) {
  const Folder folder;
  const auto car_at = [](const std::string& speed) {
    return "[simulation]\nduration = \"1 s\"\n[[vehicle]]\nname = \"car\"\nmodel = \"sedan\"\nspeed = \"" + speed + "\"\n";
  };
  const std::string car = car_at("40 km/h");
  const auto told = [&folder](const std::string& scene) {
    folder.write("a.toml", scene);
    const Result result = run(folder, {"check", "a.toml"});
    EXPECT_EQ(result.code, 0);
    return result.err;
  };
  EXPECT_EQ(told(car + kPerson + "position = \"6 0 m\"\n"), "");
  EXPECT_EQ(told(car + kPerson), "a.toml: p stands inside car at the start\n");
  EXPECT_THAT(told(car_at("400 km/h") + kPerson + "position = \"6 0 m\"\n"),
              HasSubstr("car starts at 400 km/h, faster than 250 km/h; is the unit right?"));
  const std::string heavy = "front = \"-3 0 m\"\n" + kPerson + "position = \"6 0 m\"\n";
  EXPECT_THAT(told(car + "mass = \"1.5 kg\"\n" + heavy), HasSubstr("car has a mass of 1.5 kg and is 4.64 m long"));
  EXPECT_THAT(told(car + "mass = \"1500 t\"\n" + heavy), HasSubstr("m high; is the unit right?"));
  EXPECT_EQ(told(car + "mass = \"1800 kg\"\n" + heavy),
            "a.toml:7:8: vehicle.car.mass is 1.2 times the model's; its inertia is taken as that many times the model's, unless "
            "`inertia` is given\n    7 | mass = \"1800 kg\"\n      |        ^\n");
  EXPECT_EQ(told(car + "mass = \"1800 kg\"\ninertia = \"700 3300 3500 kg m^2\"\n" + heavy), "");
  EXPECT_EQ(told(car + "cg = \"0.1 0 2.5 m\"\n" + heavy),
            "a.toml: car has its centre of mass outside its bodywork, 2.5 m above the road; is the unit right?\n");
  EXPECT_THAT(told(car + "steer = \"30 rad\"\n" + heavy),
              HasSubstr("car steers by up to 1719 deg, farther than 68.8 deg; is the unit right?"));
  EXPECT_EQ(told(car_at("10 km/h") + kPerson + "position = \"6 0.5 m\"\nvelocity = \"0 3 0 m/s\"\n"),
            "a.toml: nothing touches: p/right_forearm and car come no nearer than 2.65 m, at 0.70 s\n");
  EXPECT_EQ(told(car_at("0 km/h") + kPerson + "position = \"6 0 m\"\n"), "") << "nobody goes anywhere";
  EXPECT_THAT(told(car + kPerson + "position = \"200 0 m\"\n"), HasSubstr("p can touch nothing: at the start it is at least 19"));
  EXPECT_EQ(told(car + kPerson + "height = \"1.7 m\"\nposition = \"6 0 m\"\n"),
            "a.toml: p starts 1.7 m above the ground; the length of the body is `stature`\n"
            "a.toml: nothing touches: p/left_foot and car come no nearer than 0.26 m, at 0.57 s\n");
  const std::string hovering = kPerson + "height = \"0.4 m\"\nposition = \"6 0 m\"\n";
  EXPECT_EQ(told(car + hovering),
            "a.toml: p hovers 0.4 m above the ground until something touches it; zero_condition = false lets it fall\n");
  EXPECT_EQ(told(car + hovering + "zero_condition = false\n"), "");
  EXPECT_EQ(told(car + hovering +
                 "[[body]]\nname = \"platform\"\nfixed = true\nmass = \"1 kg\"\naxes = \"0.5 0.5 0.2 m\"\nexponent = 30\nposition "
                 "= \"6 0 0.2 m\"\n"),
            "");
  EXPECT_EQ(told(car + kPerson + "position = \"6 0 m\"\n[ground]\nfriction = 5\n"),
            "a.toml: ground.friction is 5; dry asphalt has 0.7 to 0.8\n");
  EXPECT_THAT(told(car + "[[camera]]\nname = \"back\"\nposition = \"-9 0 2 m\"\ntarget = \"-20 0 2 m\"\n"),
              HasSubstr("camera back looks away: no vehicle, person or body comes into its picture"));
  EXPECT_THAT(told(car + "[[vehicle]]\nname = \"other\"\nmodel = \"sedan\"\nposition = \"3 0.5 m\"\n"), HasSubstr("overlap"));
}

TEST(Check, SeesWhatAPersonHighUpLiesOn) {
  const Folder folder;
  const auto told = [&folder](const std::string& height) {
    folder.write("a.toml", "[simulation]\nduration = \"1 s\"\n[[vehicle]]\nname = \"van\"\nmodel = \"van\"\n" + kPerson +
                               "pose = \"lying_supine\"\nposition = \"-0.5 0 m\"\nzero_condition = false\nheight = \"" + height +
                               "\"\n");
    return run(folder, {"check", "a.toml"}).err;
  };
  EXPECT_EQ(told("2.342 m"), "");
  EXPECT_THAT(told("9 m"), HasSubstr("p starts 9 m above the ground; the length of the body is `stature`"));
}

TEST(Check, TellsOfCardsThatAreTooFull) {
  const Folder folder;
  const auto told = [&folder](int lines) {
    std::string text = kBall + "[output]\nwidth = 640\nheight = 360\n[[card]]\ntitle = \"Assumptions\"\nlines = [";
    for (int i = 0; i < lines; ++i) text += "\"line\", ";
    folder.write("a.toml", text + "]\n");
    return run(folder, {"check", "a.toml"}).err;
  };
  EXPECT_EQ(told(10), "");
  EXPECT_THAT(told(45), testing::ContainsRegex("a.toml: card 1 has 45 lines, of which [0-9]+ fit on 640x360 in letters that can be "
                                               "read; the others are left out\n"));
  const Result drawn = run(folder, {"render", "a.toml", "-o", "a.mp4", "--to", "0.1s"});
  EXPECT_THAT(drawn.err, HasSubstr("crashreel: warning: card 1 has 45 lines, of which "));
}

TEST(Check, ExpectsNoExchangeOfTwoVehiclesBeforeTheyMeet) {
  const Folder folder;
  const std::string asked = "collision = \"kudlich_slibar\"\n";
  folder.write("a.toml", "[simulation]\nduration = \"1 s\"\n[[vehicle]]\nname = \"car\"\nmodel = \"sedan\"\nspeed = \"50 km/h\"\n" +
                             asked + "[[vehicle]]\nname = \"other\"\nmodel = \"sedan\"\nposition = \"12 0.5 m\"\n" + asked +
                             "[[impact]]\na = \"car\"\nb = \"other\"\nrestitution = 0.1\n");
  const Result result = run(folder, {"check", "a.toml"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.err, "");
}

TEST(Simulate, ARunWithoutATouchSaysSo) {
  const Folder folder;
  folder.write("a.toml", "[simulation]\nduration = \"0.1 s\"\n[[vehicle]]\nname = \"car\"\nmodel = \"sedan\"\n" + kPerson +
                             "position = \"9 3 m\"\n");
  const Result result = run(folder, {"simulate", "a.toml", "-o", "some/where/out"});
  EXPECT_EQ(result.code, 0) << "folders that are missing are made";
  EXPECT_EQ(result.err, "crashreel: note: nothing touched: no vehicle or person met anything but the ground in this run\n");
}

/// Hands and feet hold on where the pose has them. Of a child on an adult's bicycle that is in the air.
TEST(Check, TellsOfRidersWhoDoNotFitWhatTheyRide) {
  const Folder folder;
  const auto told = [&](const std::string& mount, const std::string& rider) {
    folder.write("a.toml", "[simulation]\nduration = \"20 ms\"\n[[vehicle]]\nname = \"m\"\nmodel = \"" + mount +
                               "\"\nspeed = \"4 m/s\"\n" + kPerson + "rides = \"m\"\n" + rider);
    const Result check = run(folder, {"check", "a.toml"}), run_of = run(folder, {"simulate", "a.toml", "-o", "out", "--overwrite"});
    EXPECT_EQ(check.code, 0) << check.err;
    EXPECT_EQ(check.err.find("does not fit") == std::string::npos, run_of.err.find("does not fit") == std::string::npos);
    return check.err;
  };
  for (const std::string stature : {"1.5 m", "1.75 m", "2 m"}) {
    EXPECT_EQ(told("bicycle", "pose = \"cyclist\"\nstature = \"" + stature + "\"\n"), "") << stature;
    EXPECT_EQ(told("motorcycle", "pose = \"motorcyclist\"\nstature = \"" + stature + "\"\n"), "") << stature;
  }
  EXPECT_THAT(told("bicycle", "pose = \"cyclist\"\nfigure = \"child-3\"\n"),
              testing::AllOf(HasSubstr("p does not fit m: "), HasSubstr("left_forearm and right_forearm hold nothing within reach"),
                             HasSubstr("do not reach down to the axles")));
  EXPECT_THAT(told("motorcycle", "pose = \"motorcyclist\"\nfigure = \"child-3\"\n"), HasSubstr("p does not fit m: "));
  EXPECT_THAT(told("bicycle", "pose = \"standing\"\n"), HasSubstr("foot"));
}

/// A bump is road to wheels: no contact is told of it, and yet it was met.
TEST(Simulate, NamesWhatWheelsRolledOver) {
  const Folder folder;
  folder.write("bump.obj",
               "v 3 -4 0\nv 3.4 -4 0.05\nv 3.8 -4 0\nv 3 4 0\nv 3.4 4 0.05\nv 3.8 4 0\nf 1 2 5 4\nf 2 3 6 5\nf 1 4 6 3\nf 1 3 2\n"
               "f 4 5 6\n");
  folder.write("a.toml",
               "[simulation]\nduration = \"0.8 s\"\n[[vehicle]]\nname = \"car\"\nmodel = \"sedan\"\nspeed = \"5 m/s\"\n"
               "[[body]]\nname = \"bump\"\nfixed = true\nmesh = \"bump.obj\"\n" +
                   kPerson + "position = \"9 5 m\"\n");
  EXPECT_EQ(run(folder, {"simulate", "a.toml", "-o", "out"}).err,
            "crashreel: note: wheels rolled over bump: no vehicle or person met anything else but the ground in this run\n");
  EXPECT_THAT(run(folder, {"check", "a.toml"}).err, HasSubstr("nothing touches but wheels and bump: "));
}

TEST(Render, AStillThatShowsNothingSaysSo) {
  const Folder folder;
  folder.write("a.toml",
               "[simulation]\nduration = \"2 s\"\n[[vehicle]]\nname = \"car\"\nmodel = \"sedan\"\nspeed = \"20 m/s\"\n"
               "[[camera]]\nname = \"side\"\nposition = \"0 -12 2 m\"\ntarget = \"0 0 1 m\"\n");
  const std::vector<std::string> at = {"--at", "0", "--at", "2", "--size", "160x90", "-o", "a.png"};
  std::vector<std::string> fixed = {"render", "a.toml", "--camera", "side"}, follows = {"render", "a.toml", "--camera", "follow"};
  for (auto* command : {&fixed, &follows}) command->insert(command->end(), at.begin(), at.end());
  EXPECT_EQ(run(folder, fixed).err, "crashreel: warning: at 2.000 s camera side shows no vehicle, person or body\n");
  follows.back() = "b.png";
  EXPECT_EQ(run(folder, follows).err, "") << "the car is in both pictures";
}

/// Corners that pass through each other within milliseconds: Kudlich-Slibar finds no impulse, but they did touch.
TEST(Simulate, AnOverlapWithoutAnImpactIsWarnedOfAndIsNoMiss) {
  const Folder folder;
  const auto sedan = [](const std::string& name, const std::string& motion) {
    return "[[vehicle]]\nmodel = \"sedan\"\ncollision = \"kudlich_slibar\"\nname = \"" + name + "\"\n" + motion;
  };
  folder.write("a.toml", "[simulation]\nduration = \"0.5 s\"\n" + sedan("a", "position = \"-10 0 m\"\nspeed = \"100 km/h\"\n") +
                             sedan("b", "position = \"0 -1.6 m\"\nheading = \"90 deg\"\nspeed = \"60 km/h\"\n"));
  const Result result = run(folder, {"simulate", "a.toml", "-o", "out"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.err,
            "crashreel: warning: a and b touched and parted before kudlich_slibar exchanged an impulse; collision = "
            "\"default_auto\" has their contact\n");
}

TEST(Simulate, AThrowThatIsNotOverSaysSo) {
  const Folder folder;
  folder.write("a.toml",
               "[simulation]\nduration = \"0.4 s\"\n[[vehicle]]\nname = \"car\"\nmodel = \"sedan\"\n"
               "front = \"-1 0 m\"\nspeed = \"40 km/h\"\n" +
                   kPerson);
  EXPECT_THAT(run(folder, {"simulate", "a.toml", "-o", "out"}).out,
              testing::ContainsRegex("throw_distance_m p +[0-9.]+ so far, still moving at the end\n"));
}

}  // namespace
}  // namespace cli_tests
