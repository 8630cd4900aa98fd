// Makes the vehicle meshes: generate_assets FOLDER. The committed files are its output; a test compares them.
#include <cstdio>
#include <exception>
#include <string>

#include "assets/generate/car.h"
#include "assets/generate/trailers.h"
#include "assets/generate/two_wheelers.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: generate_assets FOLDER\n");
    return 2;
  }
  try {
    const std::string folder = argv[1];
    assets::write_obj(assets::bodywork(), assets::car_paints(), folder + "/sedan");
    assets::write_obj(assets::shell(), {}, folder + "/sedan_collision");
    assets::write_obj(assets::wheel(), assets::wheel_paints(), folder + "/wheel");
    assets::write_obj(assets::trip_curb(), {{"concrete", {0.42, 0.41, 0.39}}}, folder + "/trip_curb");
    assets::write_obj(assets::car_trailer(), assets::trailer_paints(), folder + "/car_trailer");
    assets::write_obj(assets::dolly(), assets::trailer_paints(), folder + "/dolly");
    assets::write_obj(assets::drawbar_trailer(), assets::trailer_paints(), folder + "/drawbar_trailer");
    const auto paints = assets::two_wheeler_paints();
    assets::write_obj(assets::bicycle(), paints, folder + "/bicycle");
    assets::write_obj(assets::spoked_wheel(0.34, 0.035, 28), paints, folder + "/bicycle_wheel");
    assets::write_obj(assets::motorcycle(), paints, folder + "/motorcycle");
    assets::write_obj(assets::spoked_wheel(0.31, 0.12, 10), paints, folder + "/motorcycle_wheel");
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 3;
  }
  return 0;
}
