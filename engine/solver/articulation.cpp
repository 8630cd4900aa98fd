#include "engine/solver/articulation.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace engine {
namespace {

/// Inverse of a symmetric positive definite matrix by blocks of 3 and K - 3: fixed sizes, no loops, no allocation.
template <int K>
Eigen::Matrix<double, K, K> inverse_small(const Eigen::Matrix<double, K, K>& A) {
  if constexpr (K == 3) {
    return A.inverse();
  } else {
    constexpr int R = K - 3;
    const Mat3 Pi = A.template topLeftCorner<3, 3>().inverse();
    const Eigen::Matrix<double, 3, R> PiQ = Pi * A.template topRightCorner<3, R>();
    const Eigen::Matrix<double, R, R> Si =
        (A.template bottomRightCorner<R, R>() - A.template topRightCorner<3, R>().transpose() * PiQ).inverse();
    Eigen::Matrix<double, K, K> out;
    out.template bottomRightCorner<R, R>() = Si;
    out.template topRightCorner<3, R>() = -PiQ * Si;
    out.template bottomLeftCorner<R, 3>() = out.template topRightCorner<3, R>().transpose();
    out.template topLeftCorner<3, 3>() = Pi - out.template topRightCorner<3, R>() * PiQ.transpose();
    return out;
  }
}

/// Of J H^-1 J^T of a joint. A fixed one with long levers on light inertias leaves the blocks half the digits; it is rare enough
/// for Cholesky.
template <int K>
Eigen::Matrix<double, K, K> inverse_of_joint(const Eigen::Matrix<double, K, K>& A) {
  if constexpr (K == 6) return A.llt().solve(Mat6::Identity());
  return inverse_small<K>(A);
}

}  // namespace

Mat6 inverse_spd(const Mat6& H) {
  return inverse_small<6>(H);
}

Mat3 inertia_W(const Body& body, const Quat& q_WB) {
  const Mat3 R = q_WB.toRotationMatrix();
  return R * body.inertia_B * R.transpose();
}

Articulation::Articulation(const Model& model) : model_(model), H_(model.bodies.size()) {}

void Articulation::reset(const Topology& topology) {
  factors_.resize(topology.links.size());
}

template <int K>
void Articulation::eliminate(Factor& f, const Mat6& J_c, const Mat6& J_p, const Mat6& H, Mat6* H_parent,
                             const JointDamper* damper) {
  const Eigen::Matrix<double, K, 6> Jc = J_c.topRows<K>();
  const Mat6 Hi = inverse_spd(H);
  const Eigen::Matrix<double, 6, K> HJ = Hi * Jc.transpose();
  const Eigen::Matrix<double, K, K> A = Jc * HJ;
  const Eigen::Matrix<double, K, K> Ai = inverse_of_joint<K>(A);
  auto E = f.E.leftCols<K>();
  E.noalias() = HJ * Ai;
  f.D = Hi;
  f.D.noalias() -= E * HJ.transpose();
  if (!H_parent) {
    f.X.setZero();
    return;
  }
  Eigen::Matrix<double, K, 6> Jp = J_p.topRows<K>();
  if (damper && damper->present) {
    const Eigen::Matrix<double, 6, 3> HiB = -(Hi.rightCols<3>() * damper->matrix);  // H^-1 B, the columns of w_p
    Jp.template rightCols<3>() -= Jc * HiB;
    H_parent->bottomRightCorner<3, 3>() += damper->matrix + damper->matrix * HiB.template bottomRows<3>();
    f.X.noalias() = -(E * Jp);
    f.X.rightCols<3>() -= HiB;
  } else {
    f.X.noalias() = -(E * Jp);
  }
  auto F = f.F.leftCols<K>();
  F.noalias() = Jp.transpose() * Ai;
  H_parent->noalias() += F * Jp;
}

/// The same for the three rows of a point that two bodies share, J_c = s [-1, C], J_p = s [1, -P] with C, P skew: the most frequent
/// joint, and half of the general products are with the identity.
void Articulation::eliminate_point(Factor& f, double s, const Mat3& C, const Mat3& P, const Mat6& H, Mat6* H_parent) {
  const Mat6 Hi = inverse_spd(H);
  Eigen::Matrix<double, 6, 3> HJ = -Hi.leftCols<3>();
  HJ.noalias() -= Hi.rightCols<3>() * C;
  Mat3 A = -HJ.topRows<3>();
  A.noalias() += C * HJ.bottomRows<3>();
  const Mat3 Ai = A.inverse();
  const Eigen::Matrix<double, 6, 3> E = HJ * Ai;
  f.D = Hi;
  f.D.noalias() -= E * HJ.transpose();
  f.E.leftCols<3>() = s * E;
  if (!H_parent) {
    f.X.setZero();
    return;
  }
  f.X.leftCols<3>() = -E;
  f.X.rightCols<3>().noalias() = E * P;
  const Mat3 AiP = Ai * P, PAi = -AiP.transpose() /* P skew, A symmetric */;
  f.F.topLeftCorner<3, 3>() = s * Ai;
  f.F.block<3, 3>(3, 0) = s * PAi;
  H_parent->topLeftCorner<3, 3>() += Ai;
  H_parent->topRightCorner<3, 3>() -= AiP;
  H_parent->bottomLeftCorner<3, 3>() += PAi;
  H_parent->bottomRightCorner<3, 3>().noalias() -= PAi * P;
}

void Articulation::factor(const Topology& topology, int tree, const std::vector<Pose>& X_WB,
                          const std::vector<JointDamper>* dampers) {
  const Topology::Tree& range = topology.trees[tree];
  for (int l = range.begin; l < range.end; ++l) {
    const int b = topology.links[l].body;
    H_[b].setZero();
    H_[b].diagonal().head<3>().setConstant(model_.bodies[b].mass);
    H_[b].bottomRightCorner<3, 3>() = inertia_W(model_.bodies[b], X_WB[b].q);
  }
  for (int l = range.begin; l < range.end; ++l) {
    const Topology::Link& link = topology.links[l];
    Factor& f = factors_[l];
    Mat6& H = H_[link.body];
    if (link.joint < 0) {
      f.D = inverse_spd(H);
      f.X.setZero();
      f.rows.count = 0;
      continue;
    }
    const Joint& joint = model_.joints[link.joint];
    static const Pose kWorld;
    joint_rows(joint, joint.parent < 0 ? kWorld : X_WB[joint.parent], X_WB[joint.child], f.rows);
    const Mat6& J_c = link.body_is_joint_child ? f.rows.J_C : f.rows.J_P;
    const Mat6& J_p = link.body_is_joint_child ? f.rows.J_P : f.rows.J_C;
    const JointDamper* damper = dampers ? &(*dampers)[link.joint] : nullptr;
    if (damper && damper->present) H.bottomRightCorner<3, 3>() += damper->matrix;
    Mat6* H_parent = link.parent < 0 ? nullptr : &H_[link.parent];
    switch (f.rows.count) {
      case 3:
        if (damper && damper->present) {
          eliminate<3>(f, J_c, J_p, H, H_parent, damper);
        } else {
          const double s = link.body_is_joint_child ? 1 : -1;
          eliminate_point(f, s, s * J_c.topRightCorner<3, 3>(), -s * J_p.topRightCorner<3, 3>(), H, H_parent);
        }
        break;
      case 4:
        eliminate<4>(f, J_c, J_p, H, H_parent, damper);
        break;
      case 5:
        eliminate<5>(f, J_c, J_p, H, H_parent, damper);
        break;
      default:
        eliminate<6>(f, J_c, J_p, H, H_parent, damper);
        break;
    }
  }
}

void Articulation::set_bias(const Topology& topology, int tree, const std::vector<Pose>& X_WB, const std::vector<Twist>& V_WB) {
  const Topology::Tree& range = topology.trees[tree];
  for (int l = range.begin; l < range.end; ++l) {
    const Topology::Link& link = topology.links[l];
    if (link.joint < 0) continue;
    const Joint& joint = model_.joints[link.joint];
    static const Pose kWorld;
    const bool on_world = joint.parent < 0;
    joint_bias(joint, on_world ? kWorld : X_WB[joint.parent], X_WB[joint.child], on_world ? Vec3::Zero() : V_WB[joint.parent].w,
               V_WB[joint.child].w, factors_[l].rows);
  }
}

void Articulation::solve(const Topology& topology, int tree, std::vector<Vec6>& force, std::vector<Vec6>& a, Bias bias) const {
  const Topology::Tree& range = topology.trees[tree];
  for (int l = range.begin; l < range.end; ++l) {
    const Topology::Link& link = topology.links[l];
    if (link.parent < 0) continue;
    const Factor& f = factors_[l];
    Vec6& to = force[link.parent];
    to.noalias() += f.X.transpose() * force[link.body];
    if (bias == Bias::zero) continue;
    for (int k = 0; k < f.rows.count; ++k) to += f.F.col(k) * f.rows.bias[k];
  }
  for (int l = range.end - 1; l >= range.begin; --l) {
    const Topology::Link& link = topology.links[l];
    const Factor& f = factors_[l];
    Vec6& out = a[link.body];
    out.noalias() = f.D * force[link.body];
    if (link.parent >= 0) out.noalias() += f.X * a[link.parent];
    if (bias == Bias::zero) continue;
    for (int k = 0; k < f.rows.count; ++k) out += f.E.col(k) * f.rows.bias[k];
  }
}

}  // namespace engine
