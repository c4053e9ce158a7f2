#include "nerf/field/pose_refinement.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "nerf/field/tensor_span.h"

namespace nerf {
namespace {

// An orthonormal basis of the movements of all cameras under similarities of the whole scene, to
// first order. Seven columns, or fewer where movements coincide, as for cameras in one point.
Eigen::MatrixXd SimilarityBasis(const std::vector<CameraPlace>& cameras) {
  const auto count = static_cast<Eigen::Index>(cameras.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const CameraPlace& camera : cameras) mean += camera.centre / static_cast<double>(count);
  Eigen::MatrixXd moves = Eigen::MatrixXd::Zero(6 * count, 7);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Vector3d arm = cameras[i].centre - mean;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d unit = Eigen::Vector3d::Unit(axis);
      moves.block<3, 1>(6 * i, axis) = unit;  // a rotation about the mean rotates and translates
      moves.block<3, 1>(6 * i + 3, axis) = unit.cross(arm);
      moves.block<3, 1>(6 * i + 3, 3 + axis) = unit;
    }
    moves.block<3, 1>(6 * i + 3, 6) = arm;
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(moves);
  const Eigen::MatrixXd thin = Eigen::MatrixXd::Identity(6 * count, qr.rank());
  return qr.householderQ() * thin;
}

torch::Tensor DoublesOf(const Eigen::MatrixXd& matrix) {
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = matrix;
  return torch::from_blob(const_cast<double*>(rows.data()), {rows.rows(), rows.cols()},
                          torch::kDouble)
      .clone();
}

torch::Tensor Cross(const torch::Tensor& a, const torch::Tensor& b) {
  return torch::linalg_cross(a, b, 1);
}

double MedianOf(torch::Tensor values) { return values.median().item<double>(); }

}  // namespace

PoseRefinement::PoseRefinement(const std::vector<CameraPlace>& cameras,
                               const PoseRefinementOptions& options)
    : rate_(options.rate) {
  TORCH_CHECK(!cameras.empty(), "PoseRefinement: no photographs");
  const auto count = static_cast<std::int64_t>(cameras.size());
  std::int64_t lenses = 0;
  std::vector<std::int64_t> lens;
  Eigen::MatrixXd axes(count, 3);
  for (std::int64_t i = 0; i < count; ++i) {
    TORCH_CHECK(cameras[i].lens >= 0, "PoseRefinement: lens ", cameras[i].lens);
    lenses = std::max(lenses, cameras[i].lens + 1);
    lens.push_back(cameras[i].lens);
    axes.row(i) = cameras[i].axis;
  }
  twist_ = register_parameter("twist", torch::zeros({count, 6}));
  log_focal_ = register_parameter("log_focal", torch::zeros({lenses}));
  similarities_ =
      register_buffer("similarities", DoublesOf(SimilarityBasis(cameras)).to(torch::kFloat));
  axis_ = register_buffer("axis", DoublesOf(axes).to(torch::kFloat));
  lens_ = TensorOf(lens, {count}, torch::kLong).clone();
}

torch::Tensor PoseRefinement::Twists() const {
  const torch::Tensor flat = rate_ * twist_.reshape({-1, 1});
  return (flat - similarities_.matmul(similarities_.t().matmul(flat))).reshape({-1, 6});
}

torch::Tensor PoseRefinement::LogFocals() const { return rate_ * log_focal_; }

// With f times the focal length, the pixel at (x, y, 1) is at (x, y, f).
torch::Tensor PoseRefinement::ScaleFocalLength(const torch::Tensor& direction,
                                               const torch::Tensor& axis,
                                               const torch::Tensor& log_f) {
  const torch::Tensor along = (axis * direction).sum(1, true);
  const torch::Tensor length = (1 + torch::expm1(2 * log_f) * along.square()).sqrt();
  return (direction + torch::expm1(log_f) * along * axis) / length;
}

RefinedRays PoseRefinement::forward(const torch::Tensor& origin, const torch::Tensor& direction,
                                    const torch::Tensor& photograph) {
  TORCH_CHECK(origin.sizes() == direction.sizes() && origin.size(0) == photograph.size(0),
              "PoseRefinement: origin ", origin.sizes(), ", direction ", direction.sizes(),
              " and photograph ", photograph.sizes(), " do not match");
  const torch::Tensor twist = Twists().index_select(0, photograph);
  const torch::Tensor rotation = twist.slice(1, 0, 3), translation = twist.slice(1, 3, 6);

  const torch::Tensor log_f =
      LogFocals().index_select(0, lens_.index_select(0, photograph)).unsqueeze(1);
  const torch::Tensor scaled =
      ScaleFocalLength(direction, axis_.index_select(0, photograph), log_f);

  // Rodrigues' formula as a series in the square of the angle, which is smooth at 0.
  const torch::Tensor a = rotation.square().sum(1, true);
  const torch::Tensor sine = 1 - a / 6 * (1 - a / 20 * (1 - a / 42 * (1 - a / 72)));
  const torch::Tensor cosine = 0.5 - a / 24 * (1 - a / 30 * (1 - a / 56 * (1 - a / 90)));
  const torch::Tensor once = Cross(rotation, scaled);
  const torch::Tensor rotated = scaled + sine * once + cosine * Cross(rotation, once);
  return {origin + translation, rotated};
}

RayBatch WithRefinedRays(const RayBatch& rays, const RefinedRays& refined) {
  RayBatch out = rays;
  const auto copy = [](const torch::Tensor& from, std::vector<float>& to) {
    const torch::Tensor flat = from.detach().to(torch::kFloat).contiguous();
    const auto values = Span<const float>(flat);
    to.assign(values.begin(), values.end());
  };
  copy(refined.origin, out.origin);
  copy(refined.direction, out.direction);
  return out;
}

Eigen::Isometry3d PoseRefinement::Refined(std::int64_t photograph,
                                          const Eigen::Isometry3d& normalized_from_camera) const {
  const torch::NoGradGuard no_grad;
  const torch::Tensor twist = Twists()[photograph].to(torch::kDouble).contiguous();
  const Eigen::Map<const Eigen::Matrix<double, 6, 1>> values(twist.data_ptr<double>());
  const Eigen::Vector3d rotation = values.head<3>();
  Eigen::Isometry3d refined = normalized_from_camera;
  if (rotation.norm() > 0) {
    refined.linear() = Eigen::AngleAxisd(rotation.norm(), rotation.normalized()) * refined.linear();
  }
  refined.translation() += values.tail<3>();
  return refined;
}

PoseRefinementSummary Summarize(const PoseRefinement& poses) {
  const torch::NoGradGuard no_grad;
  const torch::Tensor twist = poses.Twists().to(torch::kDouble);
  const torch::Tensor degrees = twist.slice(1, 0, 3).norm(2, 1) * (180 / std::numbers::pi);
  const torch::Tensor shift = twist.slice(1, 3, 6).norm(2, 1);
  return {MedianOf(degrees), degrees.max().item<double>(), MedianOf(shift),
          shift.max().item<double>(), torch::expm1(poses.LogFocals()).abs().max().item<double>()};
}

}  // namespace nerf
