#include "engine/solver/articulation.h"

#include <Eigen/LU>
#include <algorithm>
#include <cassert>

#include "engine/math/same_bits.h"
#include "engine/solver/wide_links.h"

namespace engine {
namespace {

/// Inverse of a symmetric positive definite matrix by blocks of 3: fixed sizes, no loops, no allocation.
Mat6 inverse_spd(const Mat6& A) {
  const Mat3 Pi = A.topLeftCorner<3, 3>().inverse();
  const Mat3 PiQ = Pi * A.topRightCorner<3, 3>();
  const Mat3 Si = (A.bottomRightCorner<3, 3>() - A.topRightCorner<3, 3>().transpose() * PiQ).inverse();
  Mat6 out;
  out.bottomRightCorner<3, 3>() = Si;
  out.topRightCorner<3, 3>() = -PiQ * Si;
  out.bottomLeftCorner<3, 3>() = out.topRightCorner<3, 3>().transpose();
  out.topLeftCorner<3, 3>() = Pi - out.topRightCorner<3, 3>() * PiQ.transpose();
  return out;
}

/// A motion of the body that gives the rows the right-hand side g; any other differs by what the joint leaves free.
Vec6 particular(const JointRows& rows, bool body_is_joint_child, const Vec3& r) {
  const double s = body_is_joint_child ? -1 : 1;
  const int turns = rows.held_along;  // where the rows on the attitude begin
  Vec3 w = Vec3::Zero();
  switch (rows.held_turns()) {
    case 0:
      break;
    case 1:
      w = s * rows.bias[turns] / rows.n[0].squaredNorm() * rows.n[0];
      break;
    case 2: {
      const double aa = rows.n[0].squaredNorm(), ab = rows.n[0].dot(rows.n[1]), bb = rows.n[1].squaredNorm();
      const double x = rows.bias[turns], y = rows.bias[turns + 1];
      w = s / (aa * bb - ab * ab) * ((bb * x - ab * y) * rows.n[0] + (aa * y - ab * x) * rows.n[1]);
      break;
    }
    default: {
      Mat3 N;
      N << rows.n[0].transpose(), rows.n[1].transpose(), rows.n[2].transpose();
      w = s * (N.inverse() * rows.bias.segment<3>(turns));
    }
  }
  Vec6 c;
  c << s * along_held(rows, rows.bias) + r.cross(w), w;
  return c;
}

}  // namespace

Mat3 inertia_W(const Body& body, const Quat& q_WB) {
  const Mat3& I = body.inertia_B;
  // axes of a body are as a rule its principal ones: without the products with zeros, which change no bit
  if (I(1, 0) == 0 && I(2, 0) == 0 && I(2, 1) == 0) {
    Mat3 turned;
    turn_inertia(q_WB.coeffs().data(), I.data(), turned.data());
    return turned;
  }
  const Mat3 R = q_WB.toRotationMatrix(), RI = R * I;
  return RI * R.transpose();
}

Articulation::Articulation(const Model& model) : model_(model) {}

void Articulation::reset(const Topology& topology) {
  factors_.resize(topology.links.size());
  H_.resize(topology.links.size());
  places_.assign(topology.links.size(), {});
  undamped_.assign(topology.trees.size(), 0);
}

void Articulation::take_over(Articulation& other) {
  factors_.swap(other.factors_);
  H_.swap(other.H_);
  places_.swap(other.places_);
  undamped_.swap(other.undamped_);
  std::fill(other.undamped_.begin(), other.undamped_.end(), 0);
}

/// X0 = [1, -skew(d); 0, 1]: the parent's motion carried to the body as if the joint were locked.
Mat6 Articulation::locked(const Hinge& hinge) {
  Mat6 X0 = Mat6::Identity();
  X0.topRightCorner<3, 3>() = -skew(hinge.r_parent - hinge.r);
  return X0;
}

/// Two axes of turning, S_w: the body's centre makes S = [skew(r) S_w; S_w].
void Articulation::eliminate_cross(Factor& f, const Hinge& hinge, const Mat6& H, Mat6* H_parent) {
  using Two = Eigen::Matrix<double, 6, 2>;
  const Eigen::Matrix<double, 3, 2> S_w = motion_subspace(f.rows).block<3, 2>(3, f.rows.slides());
  Two S;
  for (int k = 0; k < 2; ++k) S.col(k) << hinge.r.cross(S_w.col(k)), S_w.col(k);
  const Two HS = H * S;
  Eigen::Matrix2d K = S.transpose() * HS;
  if (hinge.damper && hinge.damper->present) K += S_w.transpose() * hinge.damper->turning * S_w;
  const Two SKi = S * K.inverse();
  f.D.noalias() = SKi * S.transpose();
  if (!H_parent) {
    f.X.setZero();
    return;
  }
  const Mat6 X0 = locked(hinge);
  f.X = X0;
  f.X.noalias() -= SKi * (HS.transpose() * X0);
  H_parent->noalias() += X0.transpose() * (H * f.X);
}

/// A free ball and a hinge, the joints of persons, have products of their own, and a slide comes after the turns.
[[gnu::always_inline]] inline void Articulation::eliminate_any(Factor& f, const Hinge& hinge, const Mat6& H, Mat6* H_parent) {
  const bool damped = hinge.damper && hinge.damper->present;
  double* parent = H_parent ? H_parent->data() : nullptr;
  switch (f.rows.turns()) {
    case 3:
      if (damped)
        eliminate_damped_point(H.data(), hinge.r.data(), hinge.r_parent.data(), hinge.damper->turning.data(), f.D.data(),
                               f.X.data(), parent);
      else
        eliminate_point(H.data(), hinge.r.data(), hinge.r_parent.data(), f.D.data(), f.X.data(), parent);
      break;
    case 1: {
      const Vec3& axis = f.rows.u[0];
      const double damping = damped ? (axis.transpose() * hinge.damper->turning * axis)(0) : 0;
      eliminate_hinge(H.data(), hinge.r.data(), hinge.r_parent.data(), axis.data(), damping, f.D.data(), f.X.data(), parent);
      break;
    }
    case 0:
      eliminate_fixed(f, hinge, H, H_parent);
      break;
    default:
      eliminate_cross(f, hinge, H, H_parent);
  }
  if (f.rows.slides() > 0) eliminate_slide(f, hinge, H, H_parent);
}

/// One freedom s more beside those that D and X know: p = (1 - D H) s answers, D gains p p^T / (s^T H p), and X and what the parent
/// carries lose by the same.
void Articulation::eliminate_slide(Factor& f, const Hinge& hinge, const Mat6& H, Mat6* H_parent) {
  assert(f.rows.slides() == 1);
  const Vec3 along = f.rows.d.col(f.rows.held_along);
  const double damping = hinge.damper && hinge.damper->present ? along.dot(hinge.damper->sliding * along) : 0;
  Vec6 p = -(f.D * (H.leftCols<3>() * along));
  p.head<3>() += along;
  const Vec6 Hp = H * p;
  const double inverse = 1 / (along.dot(Hp.head<3>()) + damping);
  const Vec6 share = inverse * p;
  f.D.noalias() += share * p.transpose();
  if (!H_parent) return;
  // X0^T H p
  Vec6 carried = Hp;
  carried.tail<3>() += (hinge.r_parent - hinge.r).cross(Hp.head<3>());
  f.X.noalias() -= share * carried.transpose();
  H_parent->noalias() -= carried * (inverse * carried).transpose();
}

/// No freedom at all: the parent carries the body as its own.
void Articulation::eliminate_fixed(Factor& f, const Hinge& hinge, const Mat6& H, Mat6* H_parent) {
  f.D.setZero();
  f.X.setZero();
  if (!H_parent) return;
  f.X = locked(hinge);
  H_parent->noalias() += f.X.transpose() * H * f.X;
}

JointRows& Articulation::rows_at(const Topology& topology, int link, const std::vector<Pose>& X_WB) {
  static const Pose kWorld;
  const Joint& joint = model_.joints[topology.links[link].joint];
  const Pose &X_WP = joint.parent < 0 ? kWorld : X_WB[joint.parent], &X_WC = X_WB[joint.child];
  JointRows& rows = of_link(link).rows;
  Place& place = places_[link];
  if (place.rows && same_bits(place.X_WC, X_WC) && same_bits(place.X_WP, X_WP)) return rows;
  joint_rows(joint, X_WP, X_WC, rows);
  undamped_[topology.links[link].tree] = 0;
  place.rows = true;
  place.X_WP = X_WP;
  place.X_WC = X_WC;
  return rows;
}

const Mat3& Articulation::inertia_at(const Topology& topology, int link, const Quat& q_WB) {
  Place& place = places_[link];
  if (!place.turned || !same_bits(place.q_WB, q_WB)) {
    place.turned = true;
    place.q_WB = q_WB;
    place.inertia = inertia_W(model_.bodies[topology.links[link].body], q_WB);
  }
  return place.inertia;
}

void Articulation::factor(const Topology& topology, int tree, const std::vector<Pose>& X_WB,
                          const std::vector<JointDamper>* dampers) {
  const Topology::Tree& range = topology.trees[tree];
  for (int l = range.begin; l < range.end; ++l) {
    const int b = topology.links[l].body;
    Mat6& H = H_[l];
    H.setZero();
    H.diagonal().head<3>().setConstant(model_.bodies[b].mass);
    H.bottomRightCorner<3, 3>() = inertia_at(topology, l, X_WB[b].q);
  }
  for (int l = range.begin; l < range.end; ++l) {
    const Topology::Link& link = topology.links[l];
    Factor& f = of_link(l);
    const Mat6& H = H_[l];
    if (link.joint < 0) {
      f.D = inverse_spd(H);
      f.X.setZero();
      f.rows.count = 0;
      continue;
    }
    rows_at(topology, l, X_WB);
    const bool child = link.body_is_joint_child;
    const Hinge hinge{child ? f.rows.r_C : f.rows.r_P, child ? f.rows.r_P : f.rows.r_C,
                      dampers ? &(*dampers)[link.joint] : nullptr};
    eliminate_any(f, hinge, H, link.parent < 0 ? nullptr : &H_[topology.link_of_body[link.parent]]);
  }
  undamped_[tree] = dampers == nullptr;
}

void Articulation::factor_unless_known(const Topology& topology, int tree, const std::vector<Pose>& X_WB) {
  const Topology::Tree& range = topology.trees[tree];
  // the root stands where its children's rows have it; by itself it takes no time
  bool known = undamped_[tree] != 0 && range.end - range.begin > 1;
  for (int l = range.begin; known && l < range.end; ++l) {
    if (topology.links[l].joint < 0) continue;
    const Joint& joint = model_.joints[topology.links[l].joint];
    const Place& place = places_[l];
    known = same_bits(place.X_WC, X_WB[joint.child]) && (joint.parent < 0 || same_bits(place.X_WP, X_WB[joint.parent]));
  }
  if (!known) factor(topology, tree, X_WB, nullptr);
}

void Articulation::set_bias(const Topology& topology, int tree, const std::vector<Twist>& V_WB) {
  const Topology::Tree& range = topology.trees[tree];
  for (int l = range.begin; l < range.end; ++l) {
    const Topology::Link& link = topology.links[l];
    if (link.joint < 0) continue;
    const Joint& joint = model_.joints[link.joint];
    joint_bias(joint.parent < 0 ? kStill : V_WB[joint.parent], V_WB[joint.child], of_link(l).rows);
  }
}

void Articulation::solve(const Topology& topology, int tree, std::vector<Vec6>& force, std::vector<Vec6>& a, Bias bias) const {
  const Topology::Tree& range = topology.trees[tree];
  for (int l = range.begin; l < range.end; ++l) {
    const Topology::Link& link = topology.links[l];
    const Factor& f = of_link(l);
    if (bias == Bias::from_rows && f.rows.count == 3 && f.rows.held_along == 3) {
      // a shared point: no turning is asked for
      const Vec3 c = (link.body_is_joint_child ? -1 : 1) * f.rows.bias.head<3>();
      a[link.body] << c, Vec3::Zero();
      take_bias(H_[l].data(), c.data(), force[link.body].data());
    } else if (bias == Bias::from_rows && link.joint >= 0) {
      a[link.body] = particular(f.rows, link.body_is_joint_child, link.body_is_joint_child ? f.rows.r_C : f.rows.r_P);
      force[link.body].noalias() -= H_[l] * a[link.body];
    } else {
      a[link.body].setZero();
    }
    if (link.parent >= 0) pass_up(f.X.data(), force[link.body].data(), force[link.parent].data());
  }
  for (int l = range.end - 1; l >= range.begin; --l) {
    const Topology::Link& link = topology.links[l];
    const Factor& f = of_link(l);
    answer(f.D.data(), force[link.body].data(), f.X.data(), link.parent >= 0 ? a[link.parent].data() : nullptr,
           a[link.body].data());
  }
}

}  // namespace engine
