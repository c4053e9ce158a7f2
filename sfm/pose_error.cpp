#include "sfm/pose_error.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numbers>
#include <vector>

#include "nerf/base/input_error.h"
#include "nerf/base/quantile.h"

namespace nerf::sfm {
namespace {

std::string FileNameOf(const PosedImage& image) { return image.path.filename().string(); }

// The rotation that turns the cameras best, in least squares of matrices: other than that of the
// centres, it is defined where these lie on a line.
Eigen::Matrix3d BestRotation(const std::vector<const PosedImage*>& found,
                             const std::vector<const PosedImage*>& truth) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < found.size(); ++i) {
    sum += truth[i]->world_from_camera.linear() * found[i]->world_from_camera.linear().transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

PoseErrors Compare(const PosedImages& found, const PosedImages& truth,
                   std::string (*key)(const PosedImage&)) {
  std::map<std::string, const PosedImage*> true_image;
  for (const PosedImage& image : truth.images) true_image[key(image)] = &image;
  std::vector<const PosedImage*> a, b;
  for (const PosedImage& image : found.images) {
    const auto known = true_image.find(key(image));
    if (known == true_image.end()) continue;
    a.push_back(&image);
    b.push_back(known->second);
  }
  const auto count = static_cast<Eigen::Index>(a.size());
  if (count < 4) {
    throw InputError("{}: has the poses of {} of the photographs; give those of four or more",
                     truth.source.string(), count);
  }
  Eigen::Matrix3Xd from(3, count), to(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    from.col(i) = a[i]->world_from_camera.translation();
    to.col(i) = b[i]->world_from_camera.translation();
  }
  const Eigen::Matrix4d similarity = Eigen::umeyama(from, to);
  const Eigen::Matrix3d rotation = BestRotation(a, b);
  const Eigen::Vector3d centre = to.rowwise().mean();
  const double radius = (to.colwise() - centre).colwise().norm().mean();
  std::vector<double> degrees, distances;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::AngleAxisd error(Eigen::Matrix3d(b[i]->world_from_camera.linear().transpose() *
                                                  rotation * a[i]->world_from_camera.linear()));
    degrees.push_back(error.angle() * 180 / std::numbers::pi);
    const Eigen::Vector3d moved = (similarity * from.col(i).homogeneous()).head<3>();
    distances.push_back((moved - to.col(i)).norm() / radius);
  }
  PoseErrors errors;
  errors.images = static_cast<int>(count);
  errors.rotation_largest = *std::ranges::max_element(degrees);
  errors.position_largest = *std::ranges::max_element(distances);
  errors.rotation_median = Median(degrees);
  errors.position_median = Median(distances);
  return errors;
}

}  // namespace

PoseErrors ComparePoses(const PosedImages& found, const PosedImages& truth) {
  return Compare(found, truth, FileNameOf);
}

PoseErrors ComparePosesByName(const PosedImages& found, const PosedImages& truth) {
  return Compare(found, truth, [](const PosedImage& image) { return image.name; });
}

}  // namespace nerf::sfm
