#include "cli/output/csv.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace cli {
namespace {

/// Text of a field: quoted where a name would break the row.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

/// How far a body has come, and how its speed changes: of the interval that ends at a row.
struct Course {
  double speed = 0;         // [m/s]
  double distance = 0;      // [m] along its path
  double acceleration = 0;  // [m/s^2] rate of the speed: a brake's is negative, an impact's its mean over the interval
  double time = 0;
  engine::Vec3 at = engine::Vec3::Zero();
  bool begun = false;

  void go_on(double now, const engine::Vec3& p, double speed_now) {
    if (begun && now > time) {
      distance += (p - at).norm();
      acceleration = (speed_now - speed) / (now - time);
    }
    begun = true;
    speed = speed_now, time = now, at = p;
  }
};

}  // namespace

std::string body_name(const engine::Recording& recording, int body) {
  return body < 0 ? "ground" : recording.body_names[static_cast<std::size_t>(body)];
}

void write_trajectory(const engine::Recording& recording, WholeFile& file) {
  file.write(
      "time_s,body,x_m,y_m,z_m,qw,qx,qy,qz,vx_mps,vy_mps,vz_mps,wx_radps,wy_radps,wz_radps,speed_mps,distance_m,acceleration_"
      "mps2\n");
  fmt::memory_buffer rows;
  std::vector<Course> bodies(recording.body_names.size());
  for (const engine::Snapshot& snapshot : recording.snapshots) {
    rows.clear();
    for (std::size_t i = 0; i < snapshot.bodies.size(); ++i) {
      const auto& [X_WB, V_WB] = snapshot.bodies[i];
      bodies[i].go_on(snapshot.time, X_WB.p, V_WB.v.norm());
      fmt::format_to(std::back_inserter(rows), "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", snapshot.time,
                     field(recording.body_names[i]), X_WB.p.x(), X_WB.p.y(), X_WB.p.z(), X_WB.q.w(), X_WB.q.x(), X_WB.q.y(),
                     X_WB.q.z(), V_WB.v.x(), V_WB.v.y(), V_WB.v.z(), V_WB.w.x(), V_WB.w.y(), V_WB.w.z(), bodies[i].speed,
                     bodies[i].distance, bodies[i].acceleration);
    }
    file.write({rows.data(), rows.size()});
  }
}

void write_contacts(const engine::Recording& recording, WholeFile& file) {
  file.write(
      "time_s,kind,body_a,body_b,x_m,y_m,z_m,nx,ny,nz,depth_m,normal_force_N,tangential_force_N,normal_impulse_Ns,"
      "tangential_impulse_Ns,slip_mps,state,tangential_x_Ns,tangential_y_Ns,tangential_z_Ns\n");
  fmt::memory_buffer rows;
  for (const engine::Snapshot& snapshot : recording.snapshots) {
    rows.clear();
    for (const engine::ContactRecord& c : snapshot.contacts) {
      const engine::Vec3 along = c.impulse - c.impulse.dot(c.normal) * c.normal;
      fmt::format_to(std::back_inserter(rows), "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", snapshot.time,
                     engine::name_of(c.shapes), field(body_name(recording, c.body_a)), field(body_name(recording, c.body_b)),
                     c.point.x(), c.point.y(), c.point.z(), c.normal.x(), c.normal.y(), c.normal.z(), c.depth, c.normal_force,
                     c.tangential_force, c.normal_impulse, c.tangential_impulse, c.slip, engine::name_of(c.state), along.x(),
                     along.y(), along.z());
    }
    file.write({rows.data(), rows.size()});
  }
}

namespace {

/// Empty where it is unknown.
std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

}  // namespace

void write_impacts(const std::vector<engine::Impact>& impacts, WholeFile& file) {
  file.write(
      "phase,time_s,duration_s,body_a,body_b,law,x_m,y_m,z_m,nx,ny,nz,closing_speed_mps,impulse_x_Ns,impulse_y_Ns,impulse_z_Ns,"
      "friction_used,friction_limit,delta_v_a_mps,delta_v_b_mps,pdof_a_deg,pdof_b_deg,ees_a_mps,ees_b_mps,speed_a_before_mps,"
      "speed_a_after_mps,speed_b_before_mps,speed_b_after_mps,yaw_rate_a_before_radps,yaw_rate_a_after_radps,"
      "yaw_rate_b_before_radps,yaw_rate_b_after_radps,energy_lost_J,ees_rule,own_delta_v_a_mps,own_delta_v_b_mps,relative_speed_"
      "mps\n");
  for (const engine::Impact& i : impacts) {
    std::string row = fmt::format("{},{},{},{},{},{}", i.phase, i.time, i.duration, field(i.a.name), field(i.b.name), i.law);
    for (const double value : {i.point.x(),
                               i.point.y(),
                               i.point.z(),
                               i.normal.x(),
                               i.normal.y(),
                               i.normal.z(),
                               i.closing_speed,
                               i.impulse.x(),
                               i.impulse.y(),
                               i.impulse.z(),
                               i.friction_used,
                               i.friction_limit,
                               i.a.delta_v.norm(),
                               i.b.delta_v.norm(),
                               i.a.pdof,
                               i.b.pdof,
                               i.a.ees,
                               i.b.ees,
                               i.a.speed_before,
                               i.a.speed_after,
                               i.b.speed_before,
                               i.b.speed_after,
                               i.a.yaw_rate_before,
                               i.a.yaw_rate_after,
                               i.b.yaw_rate_before,
                               i.b.yaw_rate_after,
                               i.energy_lost})
      row += "," + number(value);
    file.write(row + "," + i.ees_rule + "," + number(i.a.own_delta_v.norm()) + "," + number(i.b.own_delta_v.norm()) + "," +
               number(i.relative_speed) + "\n");
  }
}

}  // namespace cli
