#include "engine/measure/definitions.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace engine {
namespace {

constexpr const char* kUnstruck = "no vehicle touched the person, or what it rides";
constexpr const char* kNotLanded = "the trunk did not come down on the ground after the first touch";
constexpr const char* kPath =
    "chaotic beyond the landing: see the band of `crashreel study`; the centre of mass is exact to the step";
constexpr const char* kNoHead = "no vehicle touched the head";
constexpr const char* kNoForce =
    "the contact law is default_auto, which has no force histories; or a wheel met the head, whose tyre is rigid; or the head "
    "touched "
    "nothing";
constexpr const char* kHic =
    "as good as the stiffness of head and panel (engine/geometry/panels.h); grows as speed to the 2.5, faster where the panel "
    "bottoms out";
constexpr const char* kBrush =
    "to the recorded interval; the last brush of a limb ends the one and begins the other: see the band of `crashreel study`";
constexpr const char* kPhase =
    "to the recorded interval; measured along the line from first touch to rest, so that the distances of all phases sum to "
    "throw_distance_m";
constexpr const char* kMoving = "still moving when the run ends, or still for less than 0.25 s, or creeping on";
constexpr const char* kNoDeltaV =
    "neither the vehicle nor one coupled to it touched a person, vehicle or object; or it is fixed, or went through an object";
constexpr const char* kNotRolled = "the vehicle did not roll onto its side or farther; or it is a two-wheeler";
constexpr const char* kNotDown =
    "the vehicle did not roll onto its side or farther, and its bodywork never came down so hard; or it is a two-wheeler";
constexpr const char* kNoStrike = "as ground_strikes; or the bodywork never came down so hard";
constexpr const char* kRolls = "bodywork is rigid: what it ploughs and crushes is not in it";

constexpr Definition kDefinitions[] = {
    {"throw_distance_m", "m", "throw distance",
     "Level distance of the centre of mass from where it was at the first touch with a vehicle to where it rests, or is when the "
     "run ends. Of a rider from the first touch of the rider or of what it rides; of what is ridden by itself (Simms and Wood, "
     "Pedestrian and Cyclist Impact, 2009: total throw).",
     kUnstruck, kPath, true},
    {"throw_along_m", "m", "throw along",
     "Part of the throw along the way that the vehicle goes at the first touch, forwards or backwards; of a rider along that of "
     "the faster of the two; along its heading where it stands.",
     kUnstruck, kPath},
    {"throw_across_m", "m", "throw across", "Part of the throw across that way, positive to the left.", kUnstruck, kPath},
    {"contact_m", "m", "contact",
     "Distance of the phase contact: from the first touch until the person goes as fast as the vehicle, or the vehicle last pushes "
     "it.",
     kUnstruck, kPhase},
    {"carried_m", "m", "carried",
     "Distance of the phase carried: from the end of the phase contact until the vehicle last pushes the person before it lands.",
     "the person never goes as fast as the vehicle while that pushes", kBrush},
    {"airborne_m", "m", "airborne",
     "Distance of the phase flight: from the last push of a vehicle, or of what hangs on it, to landing, if nothing touched "
     "the person for 50 ms or more meanwhile. A rider is also held by each joint to what it rides until that breaks.",
     "the person did not land, or something touched or held it at least every 50 ms before", kBrush, true},
    {"fall_m", "m", "fall",
     "Distance of the phase fall, in place of a flight: from the last push of a vehicle, or of what hangs on it, to landing, "
     "if a hand, a foot or the vehicle touched something at least every 50 ms.",
     "the person flew for 50 ms or more, was pushed until it landed, or did not land", kPhase, true},
    {"landing_m", "m", "landing",
     "Distance of the phase landing: from the trunk's touch of the ground until the bounces are over, that is until some part "
     "touches the ground without a break of 50 ms; 0 where it does not bounce.",
     kNotLanded, kPhase},
    {"slide_m", "m", "slide",
     "Distance of the phase slide: from the end of the bounces to rest, or the end of the run; a vehicle that comes over the "
     "person may push or drag it meanwhile: reports say so, and no friction follows from such a way. Of who lay on the ground when "
     "struck, and stayed on it, from the vehicle's last push.",
     "the trunk did not come down on the ground after the first touch; or it lay there, and a vehicle pushed it to the end", kPhase,
     true},
    {"landing_s", "s", "landing",
     "Time at which hips, head or what joins them first touch the ground, or a body fixed to it that they can lie on, after the "
     "first touch with a vehicle; of who lay there, after having been off it for 50 ms. Feet and hands do not count.",
     kNotLanded, "exact to the step; which part lands first is chaotic", true},
    {"first_ground_contact_s", "s", "on the ground", "The same as landing_s under its older name.", kNotLanded,
     "exact to the step; which part lands first is chaotic"},
    {"passed_over_s", "s", "passed over",
     "Time from which a vehicle is over the person who has come down or lay there: the centre of the hips is within the box of its "
     "bodywork seen from above, and lower than 0.4 m. With or without a wheel on the person, see run_over_s.",
     "no vehicle came over the person after the landing", "to the recorded interval", true},
    {"run_over_s", "s", "run over",
     "Time at which a wheel of a vehicle first stands on the person: its push on a part comes from within 26 degrees of "
     "upright; or does so as seen from the vehicle's side, from within 60 degrees in all, and bears more than half of what the "
     "vehicle's least loaded wheel bears at rest. Less than a twentieth of that never counts, nor does a wheel that shoves a part "
     "ahead, or a floor that passes over the person.",
     "no wheel stood on the person", "exact to the step", true},
    {"run_over_part", "", "run over", "The part it stands on, and whose wheel it is.", "as run_over_s", "exact to the step", true},
    {"rest_s", "s", "rest",
     "Time from which nothing of it moves faster than 0.05 m/s or 0.3 rad/s until the run ends, for 0.25 s or more; of what slides "
     "to a halt then, and no longer moves at all, the halt. Of a person its trunk: hips, head and what joins them. A hand or a "
     "foot may settle later. Of a vehicle on its wheels its way along the road and its yaw: it may go on rocking on its springs, "
     "by "
     "0.3 m/s of heave and 0.5 rad/s. What creeps on at more than 5 mm/s or 0.03 rad/s does not rest, but for a person. "
     "Of rider and mount each its own.",
     kMoving, "to the recorded interval", true},
    {"travel_m", "m", "way", "Level distance from start to end, of a person whom no vehicle touched and of free bodies.",
     "a person that was struck", kPath, true},
    {"turned_deg", "deg", "turned", "Angle between the attitudes of a free body at start and end, 0 to 180.", "not a free body",
     "exact to the step", true},
    {"rebound_height_m", "m", "rebound", "Height over the ground of a free body's lowest point at the top of its first rebound.",
     "it does not rebound within the run", "exact to the step", true},
    {"head_impact_s", "s", "head impact", "Time of the first touch of the head with a vehicle.", kNoHead,
     "10 to 20 ms between stances; exact to the step", true},
    {"head_impact_speed_mps", "m/s", "head impact speed",
     "Speed of the centre of the head relative to the vehicle's surface at the place of that touch, as it begins.", kNoHead,
     "varies with gait and offset by a fifth", true},
    {"head_impact_normal_mps", "m/s", "normal", "Part of that velocity along the surface's normal, positive: into it.", kNoHead,
     "as the speed"},
    {"head_impact_tangential_mps", "m/s", "tangential", "Part of that velocity along the surface.", kNoHead, "as the speed"},
    {"head_impact_panel", "", "panel",
     "What of the vehicle the head touches first: bonnet (with the tops of the wings and the scuttle before the windscreen), "
     "windscreen (with the frame of the pane), a_pillar, roof_edge, roof, front, side, side_window, rear (with the lid of a boot), "
     "rear_window, underside; from the material drawn nearest and the place (scenes/loader/panels.h).",
     "no vehicle touched the head; or it met a wheel or a two-wheeler, or the mesh tells no panels", "on an edge either of two",
     true},
    {"head_impact_vehicle_x_m", "m", "x on the vehicle", "Place of that touch in the axes of the vehicle's mesh, forward.", kNoHead,
     "as wrap-around distance"},
    {"head_impact_vehicle_y_m", "m", "y on the vehicle", "The same to the left.", kNoHead, "as wrap-around distance"},
    {"head_impact_vehicle_z_m", "m", "z on the vehicle", "The same upwards from the ground at static ride.", kNoHead,
     "as wrap-around distance"},
    {"wrap_around_distance_m", "m", "wrap-around distance",
     "Length of a taut tape in the vertical fore and aft plane through the head's place of touch: from the ground vertically "
     "below the foremost part over front and bonnet to that place (Euro NCAP, Pedestrian Testing Protocol, wrap around distance).",
     "the head met no vehicle that came with its front, as they went before the first touch, by 0.3 m/s or more; or a place no "
     "tape from the front "
     "reaches (flank, side window, underside)",
     "in 14 cases of Fahlstedt, Halldin and Kleiven, Traffic Inj. Prev. 17, 2016, a multibody person always wrapped farther than a "
     "finite-element one",
     true},
    {"hic15", "", "HIC15",
     "Head injury criterion of the resultant acceleration of the head's centre over windows of 15 ms at most, from the head's "
     "first touch of anything but itself on, whatever it touches (49 CFR 571.208 S6.2).",
     kNoForce, kHic, true},
    {"hic36", "", "HIC36", "The same over windows of 36 ms at most.", kNoForce, kHic},
    {"three_ms_g", "g", "3 ms clip", "Largest acceleration of the head that is held for 3 ms without a break, same course.",
     kNoForce, kHic},
    {"hic15_vehicle", "", "HIC15 vehicle",
     "HIC15 of the head's touches of vehicles alone, each from 5 ms before to 5 ms after by itself; the worst of them. While "
     "vehicle and ground push at once, the blow is of the one that pushes harder. A touch within 5 ms of a wheel's does not count.",
     kNoForce, kHic, true},
    {"three_ms_vehicle_g", "g", "3 ms clip, vehicle", "3 ms clip of the same.", kNoForce, kHic},
    {"hic15_vehicle_s", "s", "HIC15 vehicle at", "When the window of hic15_vehicle begins.", kNoForce, "as hic15_vehicle"},
    {"hic15_vehicle_by", "", "HIC15 vehicle by", "Vehicle that pushed the head hardest in that touch.", kNoForce,
     "as hic15_vehicle"},
    {"hic15_ground", "", "HIC15 ground", "The same of its touches of the ground and of bodies fixed to it alone.", kNoForce,
     "one fall of many that could have been: head against ground is highly variable (Simms and Wood, IRCOBI 2005); see the band of "
     "`crashreel study`",
     true},
    {"three_ms_ground_g", "g", "3 ms clip, ground", "3 ms clip of the same.", kNoForce,
     "as hic15_ground; a blow that gives nothing back lasts some 3 ms, and this is of its foot"},
    {"hic15_ground_s", "s", "HIC15 ground at", "When the window of hic15_ground begins.", kNoForce, "as hic15_ground"},
    {"hic15_ground_by", "", "HIC15 ground by", "The road, or which body fixed to it, that pushed the head hardest in that touch.",
     kNoForce, "as hic15_ground"},
    {"hic15_object", "", "HIC15 object",
     "The same of its touches of other persons and of things that are neither vehicles nor fixed.", kNoForce, kHic, true},
    {"three_ms_object_g", "g", "3 ms clip, object", "3 ms clip of the same.", kNoForce, kHic},
    {"hic15_object_s", "s", "HIC15 object at", "When the window of hic15_object begins.", kNoForce, "as hic15_object"},
    {"hic15_object_by", "", "HIC15 object by", "Thing or person that pushed the head hardest in that touch.", kNoForce,
     "as hic15_object"},
    {"peak_acceleration_mps2", "m/s^2", "peak acceleration",
     "Largest acceleration of a part's centre, mean over a step; free fall counts one g.", kNoForce, "grows with stiffness"},
    {"delta_v_mps", "m/s", "delta-v",
     "Largest change of the velocity of the centre of mass in the plane of the road within 250 ms of the event of its hardest "
     "collision phase, that of the largest impulse along the road, less what tyres and gravity did meanwhile: who is struck from "
     "both "
     "sides has one of the two changes and not their difference; of what was not struck itself "
     "over that in which the vehicle coupled to it was. Phases of one vehicle that overlap or follow within 20 ms are one "
     "event, whoever struck it, and so are the exchanges at an instant of two that change its velocity by more than 0.8 km/h and "
     "follow each other within 20 ms more than their penetration time. What a rider does in the same time is part of it; of a "
     "two-wheeler's tyres counts what they do under its weight and the rider's, to both. "
     "Begin and end of a phase as 49 CFR 563.5 says: exchange of more than 0.8 km/h of the lighter mass within 20 ms, 250 ms "
     "at most; without a person one of the two changes its velocity by as much, or it is shoved along and no longer struck.",
     kNoDeltaV,
     "no staged collisions are compared; for a delta-v that CRASH works out from damage the 95 % limits are 9 to 25 % (Smith and "
     "Noga 1982)",
     true},
    {"pdof_deg", "deg", "PDOF",
     "Direction in the plane of the road that delta-v's force came from, against the vehicle's heading just before the event: 0 "
     "from the front, 90 from the right, -90 from the left, 180 from behind.",
     "as delta_v_mps; or the vehicle leant by 45 degrees or more: on its side or roof", "with delta-v", true, true},
    {"ees_mps", "m/s", "EES",
     "Energy equivalent speed: speed at which the vehicle has as much kinetic energy as its share of the energy lost in the "
     "phases of the event that delta_v_mps is of. Two under the same force share it in inverse proportion to stiffness where the "
     "scene tells the stiffnesses "
     "apart, "
     "else to mass; what is fixed has none. impacts.csv names the rule.",
     "as delta_v_mps; or the hardest phase was with a person, or of a two-wheeler with a car whose stiffnesses nobody told apart, "
     "or of one with a trailer or a rider: the rule of masses is that of cars by themselves; or below the hubs against something "
     "fixed, as a kerb: wheels crush no bodywork",
     "the energy contains what friction between the two took", true},
    {"rest_x_m", "m", "rest x", "Place of the vehicle's centre of mass at rest, world x.", kMoving, "to the recorded interval",
     true},
    {"rest_y_m", "m", "rest y", "The same, world y.", kMoving, "to the recorded interval", true},
    {"rest_heading_deg", "deg", "rest heading",
     "Direction of the vehicle's x axis at rest, counter-clockwise from world x, -180 to 180.", kMoving, "to the recorded interval",
     true, true},
    {"path_m", "m", "path", "Length of the level path of the vehicle's centre of mass over the run.", "never",
     "to the recorded interval"},
    {"quarter_turns", "", "quarter turns",
     "How often a vehicle that rolled over turned by 90 degrees about its long axis until it rests, or the run ends, to the "
     "nearest: 1 on its side, 2 on its roof, 4 on its wheels again. Turns back are taken off. What it does end over end does not "
     "count.",
     kNotRolled, "exact to the run; how often it rolls is chaotic", true},
    {"trip_s", "s", "trip",
     "Time at which it last stood on wheels of both sides before it leant by 45 degrees; of one that never did, the start.",
     kNotRolled, "to the recorded interval", true},
    {"roll_distance_m", "m", "roll distance",
     "Length of the level path of its centre of mass from the trip to rest, or until it stands on wheels of both sides for good, "
     "or to the end of the run.",
     kNotRolled, kRolls, true},
    {"ground_strikes", "", "ground strikes",
     "How often the bodywork of a vehicle came down on the ground, from the trip to rest where it rolled over: beyond its weight "
     "the ground pushed it by more than 0.8 km/h times its mass within 20 ms, as collision phases are counted. The table of "
     "impacts "
     "has no rows of the ground. Scraping and what the wheels bear do not count.",
     kNotDown, kRolls, true},
    {"ground_strike_s", "s", "hardest ground strike", "Time at which the hardest of them began.", kNoStrike, kRolls, true},
    {"ground_strike_mps", "m/s", "delta-v, ground strike",
     "Impulse of the ground on the bodywork in the hardest of them over the vehicle's mass, less its weight meanwhile: what it "
     "changes of the velocity, upwards included.",
     kNoStrike, kRolls, true},
    {"ground_strike_panel", "", "panel, ground strike",
     "What of the vehicle took the hardest push of it, by the names of head_impact_panel.", kNoStrike, "on an edge either of two",
     true},
    {"roll_drag_factor", "", "roll drag factor",
     "Mean deceleration over the roll distance as a share of gravity: (v^2 / 2 g + h) / d, v the level speed of the centre of mass "
     "at the trip, h by how much lower the ground is at the end; of one that ends on its wheels less the square of what it has "
     "then (Orlowski, Moffatt, Bundorf and Holcomb, SAE 890857, 1989).",
     "as roll_distance_m, or it is still rolling when the run ends; or it struck a vehicle or an object on the way, such as the "
     "kerb that tripped it: what that took is no drag",
     kRolls, true},
    {"nearest_approach_m", "m", "nearest approach",
     "In a run in which no vehicle touches anybody: least distance of a part of a person and a vehicle's surface; without "
     "persons, of two vehicles' convex outlines seen from above.",
     "a vehicle touched a person or vehicle, or there are no two", "to the recorded interval", true},
    {"nearest_approach_s", "s", "nearest approach", "Time of that.", "as nearest_approach_m", "to the recorded interval", true},
};

}  // namespace

std::span<const Definition> definitions() {
  return kDefinitions;
}

const Definition* definition_of(const std::string& key) {
  const auto at = std::find_if(std::begin(kDefinitions), std::end(kDefinitions), [&](const Definition& d) { return d.key == key; });
  return at == std::end(kDefinitions) ? nullptr : &*at;
}

double turned_to(const std::string& key, double value, double near) {
  const Definition* known = definition_of(key.substr(0, key.find(' ')));
  return known && known->direction ? near + std::remainder(value - near, 360.0) : value;
}

}  // namespace engine
