// Makes the vehicle meshes: generate_assets FOLDER. The committed files are its output; a test compares them.
#include <cstdio>
#include <exception>
#include <string>

#include "assets/generate/car.h"
#include "assets/generate/coaches.h"
#include "assets/generate/hatchbacks.h"
#include "assets/generate/scenery.h"
#include "assets/generate/trailers.h"
#include "assets/generate/two_wheelers.h"
#include "assets/generate/wheels.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: generate_assets FOLDER\n");
    return 2;
  }
  try {
    const std::string folder = argv[1];
    assets::write_obj(assets::bodywork(), assets::car_paints(), folder + "/sedan");
    assets::write_obj(assets::shell(), {}, folder + "/sedan_collision");
    assets::write_obj(assets::wheel(0.31, 0.10, 0.215), assets::wheel_paints(), folder + "/wheel");
    assets::write_obj(assets::small_car(), assets::small_car_paints(), folder + "/small_car");
    assets::write_obj(assets::small_car_shell(), {}, folder + "/small_car_collision");
    assets::write_obj(assets::suv(), assets::suv_paints(), folder + "/suv");
    assets::write_obj(assets::suv_shell(), {}, folder + "/suv_collision");
    assets::write_obj(assets::wheel(0.29, 0.0925, 0.19), assets::wheel_paints(), folder + "/small_wheel");
    assets::write_obj(assets::wheel(0.355, 0.1125, 0.229), assets::wheel_paints(), folder + "/suv_wheel");
    assets::write_obj(assets::van(), assets::van_paints(), folder + "/van");
    assets::write_obj(assets::van_shell(), {}, folder + "/van_collision");
    assets::write_obj(assets::bus(), assets::bus_paints(), folder + "/bus");
    assets::write_obj(assets::bus_shell(), {}, folder + "/bus_collision");
    assets::write_obj(assets::truck(), assets::truck_paints(), folder + "/truck");
    assets::write_obj(assets::truck_shell(), {}, folder + "/truck_collision");
    assets::write_obj(assets::wheel(0.34, 0.1075, 0.21), assets::wheel_paints(), folder + "/van_wheel");
    assets::write_obj(assets::heavy_wheel(0.48, 0.1375, 0.29, assets::Rim::single), assets::wheel_paints(), folder + "/bus_wheel");
    assets::write_obj(assets::heavy_wheel(0.48, 0.30, 0.29, assets::Rim::twin), assets::wheel_paints(), folder + "/bus_twin_wheel");
    assets::write_obj(assets::heavy_wheel(0.43, 0.1325, 0.25, assets::Rim::single), assets::wheel_paints(),
                      folder + "/truck_wheel");
    assets::write_obj(assets::heavy_wheel(0.43, 0.28, 0.25, assets::Rim::twin), assets::wheel_paints(),
                      folder + "/truck_twin_wheel");
    assets::write_obj(assets::trip_curb(), {{"concrete", {0.42, 0.41, 0.39}}}, folder + "/trip_curb");
    assets::write_obj(assets::bank(), {{"grass", {0.38, 0.42, 0.28}}}, folder + "/bank");
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
