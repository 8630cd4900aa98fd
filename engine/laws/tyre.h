// Tyre forces in the ground plane. Forces oppose slip; a law knows no wheel and no clock.
//
// linear    F_y = mu_0 F_z tan(alpha)/tan(alpha_s) up to the friction circle mu F_z: alpha_s is the slip angle at which the tyre
//           saturates on a road that gives it its own friction mu_0. On a slippery road it keeps its stiffness and saturates at a
//           slip angle that is smaller by mu/mu_0. Longitudinally what brake or engine ask for, up to the same circle.
// TM-Easy   G. Rill, Road Vehicle Dynamics, CRC 2011, chapter 3; W. Hirschberg, G. Rill, H. Weinfurter, Tire model TMeasy, Vehicle
//           System Dynamics 45 (2007): initial slope, maximum and sliding force of either direction at the nominal load and at
//           twice that, joined through the generalised slip s = sqrt(s_x^2 + s_y^2) of slips divided by their scales.
#pragma once

namespace engine {

struct TyreForce {
  double longitudinal = 0;  // [N] against the slip of that direction
  double lateral = 0;
};

/// What one step of the wheel needs: lateral force per lateral speed and the largest force per load.
struct Grip {
  double damping = 0;   // [N s/m] secant of the lateral force at the present slip
  double friction = 0;  // [-]
};

/// `v_x`, `v_y` [m/s] of the contact point along and across the wheel; at standstill the damping is infinite: the tyre holds.
/// `mu` [-] of tyre and road, `own` [-] of the tyre, for which the saturation angle holds.
Grip linear_grip(double load, double mu, double own, double saturation_angle, double v_x, double v_y);

/// One direction at one load.
struct SlipCurve {
  double slope = 0;          // [N] dF/ds at s = 0
  double slip_max = 0;       // [-] of
  double force_max = 0;      // [N]
  double slip_sliding = 0;   // [-] from which it slides with
  double force_sliding = 0;  // [N]
};

/// Force of a curve at a slip >= 0; continuous with its slope at slip_max and slip_sliding.
double force_of(const SlipCurve&, double slip);

struct TmEasyTyre {
  double nominal_load = 4000;  // [N]
  SlipCurve x, y;              // at it
  SlipCurve x2, y2;            // at twice that
};

/// A passenger car's radial tyre (Rill 2011, table of section 3.3), its forces scaled from 4 kN to another nominal load.
TmEasyTyre passenger_car_tyre(double nominal_load);

/// Slips s_x = slip speed / |rolling speed|, s_y = v_y / |rolling speed|. `mu` [-]: friction of tyre and road in the sense of the
/// longitudinal maximum at nominal load. Forces and slips of the maximum scale with it, slopes stay.
TyreForce tm_easy_force(const TmEasyTyre&, double load, double mu, double s_x, double s_y);

/// The wheel turns at the speed at which the tyre gives `asked` [N] longitudinally (its own inertia is neglected), or is locked if
/// it cannot.
Grip tm_easy_grip(const TmEasyTyre&, double load, double mu, double v_x, double v_y, double asked);

}  // namespace engine
