
#include "nerf/kernels/gaussian_projection.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "nerf/kernels/gaussian_projection_backward.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "nerf/kernels/gaussian_footprint-inl.h"
#include "nerf/kernels/gaussian_harmonics-inl.h"
#include "nerf/kernels/gaussian_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nerf::kernels {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct Moments {
  V sum, x, y, xx, xy, yy, rgb[3], distance;
};

HWY_INLINE Moments LoadMoments(const GaussianMoments* moments) {
  const D d;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));
  constexpr int kFields = sizeof(GaussianMoments) / sizeof(float);
  alignas(64) float fields[kFields][kLanes];
  for (int l = 0; l < kLanes; ++l) {
    const auto* const values = reinterpret_cast<const float*>(&moments[l]);
    for (int k = 0; k < kFields; ++k) fields[k][l] = values[k];
  }
  const auto load = [&](int k) HWY_ATTR { return hn::Load(d, fields[k]); };
  return {load(0), load(1), load(2), load(3), load(4), load(5), {load(6), load(7), load(8)},
          load(9)};
}

// The gradients by a_x and a_y, and by the position on the screen.
struct EllipseGradient {
  Vector3 a_x, a_y;
  V x, y;
};

HWY_INLINE EllipseGradient BackThroughEllipse(const Footprint& f, const Moments& m) {
  const V half = Constant(0.5f), two = Constant(2), inverse = Constant(1) / f.det_filtered;
  // Q, the inverse of the filtered covariance.
  const V q_xx = f.c_yy * inverse, q_xy = hn::Neg(f.c_xy * inverse), q_yy = f.c_xx * inverse;
  EllipseGradient g;
  g.x = q_xx * m.x + q_xy * m.y;
  g.y = q_xy * m.x + q_yy * m.y;
  // dL/dSigma' = (Q M Q - sum Q) / 2 with the second moments M.
  const V u_xx = q_xx * m.xx + q_xy * m.xy, u_xy = q_xx * m.xy + q_xy * m.yy;
  const V u_yx = q_xy * m.xx + q_yy * m.xy, u_yy = q_xy * m.xy + q_yy * m.yy;
  const V s_xx = half * (u_xx * q_xx + u_xy * q_xy - m.sum * q_xx);
  const V s_xy = half * (u_xx * q_xy + u_xy * q_yy - m.sum * q_xy);
  const V s_yy = half * (u_yx * q_xy + u_yy * q_yy - m.sum * q_yy);
  // ln opacity' contains ln |a_x x a_y|.
  const Vector3 by_normal = Scaled(f.normal, m.sum / hn::Max(f.det, Constant(kTiny)));
  g.a_x = Add(Scaled(Add(Scaled(f.a_x, s_xx), Scaled(f.a_y, s_xy)), two), Cross(f.a_y, by_normal));
  g.a_y = Add(Scaled(Add(Scaled(f.a_x, s_xy), Scaled(f.a_y, s_yy)), two), Cross(by_normal, f.a_x));
  return g;
}

// The gradient by the point in the camera, of the position and of the Jacobian.
HWY_INLINE Vector3 BackThroughLens(const GaussianCamera& camera, const Footprint& f,
                                   const EllipseGradient& g, const Vector3& by_j_x,
                                   const Vector3& by_j_y) {
  const Ideal& ideal = f.ideal;
  const LensAt& lens = f.lens;
  const V fx = Constant(camera.fx), fy = Constant(camera.fy), zero = hn::Zero(D());
  const Vector3 h_x = Scaled(by_j_x, fx), h_y = Scaled(by_j_y, fy);
  // J = lens Jacobian times ideal Jacobian.
  V by_u, by_v;
  LensJacobianGradient(camera, lens, Dot(h_x, ideal.u_p), Dot(h_x, ideal.v_p), Dot(h_y, ideal.u_p),
                       Dot(h_y, ideal.v_p), by_u, by_v);
  const Vector3 by_u_p = Add(Scaled(h_x, lens.x_u), Scaled(h_y, lens.y_u));
  const Vector3 by_v_p = Add(Scaled(h_x, lens.x_v), Scaled(h_y, lens.y_v));
  Vector3 by_p = camera.is_fisheye
                     ? FisheyeJacobianGradient(f.p, ideal, by_u_p, by_v_p)
                     : PerspectiveJacobianGradient(camera, f.p, ideal, by_u_p, by_v_p, by_u, by_v);
  by_u = hn::IfThenElse(ideal.inside_u, by_u, zero);
  by_v = hn::IfThenElse(ideal.inside_v, by_v, zero);
  by_u = by_u + fx * g.x * lens.x_u + fy * g.y * lens.y_u;
  by_v = by_v + fx * g.x * lens.x_v + fy * g.y * lens.y_v;
  if (camera.is_fisheye) return Add(by_p, Add(Scaled(ideal.u_p, by_u), Scaled(ideal.v_p, by_v)));
  const V inverse_z = Constant(1) / hn::Max(f.p.z, Constant(camera.near));
  return Add(by_p, {by_u * inverse_z, by_v * inverse_z,
                    hn::Neg((by_u * ideal.u + by_v * ideal.v) * inverse_z)});
}

// The gradient by the quaternion, from that by the columns of its rotation.
HWY_INLINE void BackThroughRotation(const Footprint& f, const Vector3 (&g)[3], V (&out)[4]) {
  const V two = Constant(2), w = f.qw, x = f.qx, y = f.qy, z = f.qz;
  const V by_w = two * (x * (g[1].z - g[2].y) + y * (g[2].x - g[0].z) + z * (g[0].y - g[1].x));
  const V by_x = two * (w * (g[1].z - g[2].y) - two * x * (g[1].y + g[2].z) +
                        y * (g[1].x + g[0].y) + z * (g[2].x + g[0].z));
  const V by_y = two * (w * (g[2].x - g[0].z) + x * (g[1].x + g[0].y) -
                        two * y * (g[0].x + g[2].z) + z * (g[2].y + g[1].z));
  const V by_z = two * (w * (g[0].y - g[1].x) + x * (g[2].x + g[0].z) + y * (g[2].y + g[1].z) -
                        two * z * (g[0].x + g[1].y));
  const V along = by_w * w + by_x * x + by_y * y + by_z * z;
  out[0] = (by_w - along * w) * f.inverse_length;
  out[1] = (by_x - along * x) * f.inverse_length;
  out[2] = (by_y - along * y) * f.inverse_length;
  out[3] = (by_z - along * z) * f.inverse_length;
}

HWY_INLINE void AddPose(const Footprint& f, const Vector3& by_p, const Vector3& by_direction,
                        const Vector3 (&by_axes)[3], CameraGradient& pose) {
  const D d;
  Vector3 turned = Cross(f.p, by_p);
  for (int k = 0; k < 3; ++k) turned = Add(turned, Cross(f.axes[k], by_axes[k]));
  const Vector3 moved = Add(by_p, by_direction);
  const auto sum = [&](V v)
                       HWY_ATTR { return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, v))); };
  pose.turned[0] += sum(turned.x);
  pose.turned[1] += sum(turned.y);
  pose.turned[2] += sum(turned.z);
  pose.moved[0] += sum(moved.x);
  pose.moved[1] += sum(moved.y);
  pose.moved[2] += sum(moved.z);
}

// The gradients of a vector of Gaussians by all that is not colour.
struct ShapeGradient {
  Vector3 p;        // by the point in the camera
  Vector3 axes[3];  // by the scaled axes in the camera
  EllipseGradient ellipse;
};

HWY_INLINE ShapeGradient BackThroughShape(const GaussianCamera& camera, const Footprint& f,
                                          const Moments& m) {
  ShapeGradient g;
  g.ellipse = BackThroughEllipse(f, m);
  const Vector3 &a_x = g.ellipse.a_x, &a_y = g.ellipse.a_y;
  const auto by_row = [&](const Vector3& a) HWY_ATTR {
    return Add(Add(Scaled(f.axes[0], a.x), Scaled(f.axes[1], a.y)), Scaled(f.axes[2], a.z));
  };
  g.p = Add(BackThroughLens(camera, f, g.ellipse, by_row(a_x), by_row(a_y)),
            Scaled(f.p, m.distance / hn::Max(f.distance, Constant(kTiny))));
  g.axes[0] = Add(Scaled(f.j_x, a_x.x), Scaled(f.j_y, a_y.x));
  g.axes[1] = Add(Scaled(f.j_x, a_x.y), Scaled(f.j_y, a_y.y));
  g.axes[2] = Add(Scaled(f.j_x, a_x.z), Scaled(f.j_y, a_y.z));
  return g;
}

// Writes the rows of scales, rotation and opacity.
HWY_INLINE void StoreShape(const GaussianCamera& camera, const Footprint& f, const ShapeGradient& g,
                           V by_log_opacity, const float* block, float* out) {
  const D d;
  const auto store = [&](int row, V v) HWY_ATTR {
    hn::StoreU(hn::IfThenElseZero(f.visible, v), d, out + kGaussiansInBlock * row);
  };
  const M bounded[3] = {f.bounded_x, f.bounded_y, f.bounded_z};
  const V scales[3] = {f.scale.x, f.scale.y, f.scale.z};
  Vector3 by_rotation[3];
  for (int k = 0; k < 3; ++k) {
    store(kLogScaleRow + k, hn::IfThenElseZero(bounded[k], Dot(g.axes[k], f.axes[k])));
    by_rotation[k] = RotatedBack(camera, Scaled(g.axes[k], scales[k]));
  }
  V by_quaternion[4];
  BackThroughRotation(f, by_rotation, by_quaternion);
  for (int k = 0; k < 4; ++k) store(kRotationRow + k, by_quaternion[k]);
  // 1 - sigmoid, without a difference of equal numbers.
  const V logit = hn::LoadU(d, block + kGaussiansInBlock * kOpacityRow);
  const V bounded_logit = hn::Max(hn::Min(logit, Constant(80)), Constant(-80));
  store(kOpacityRow, by_log_opacity / (Constant(1) + hn::CallExp(d, bounded_logit)));
}

// Invisible Gaussians have moments of 0, but their footprint may be infinite.
void BackwardImpl(const GaussianCamera& camera, int order, const float* block,
                  const GaussianMoments* moments, float* gradient, float* on_screen,
                  CameraGradient* pose) {
  const D d;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));
  const V zero = hn::Zero(d);
  Footprint f;
  for (int lane = 0; lane < kGaussiansInBlock; lane += kLanes) {
    const float* const p = block + lane;
    float* const out = gradient + lane;
    if (!PlaceMean(camera, p, f)) {
      for (int row = 0; row < GaussianRows(order); ++row) {
        hn::StoreU(zero, d, out + kGaussiansInBlock * row);
      }
      hn::StoreU(zero, d, on_screen + lane);
      continue;
    }
    PlaceEllipse(camera, p, f);
    const auto kept = [&](const Vector3& v) HWY_ATTR {
      return Vector3{hn::IfThenElseZero(f.visible, v.x), hn::IfThenElseZero(f.visible, v.y),
                     hn::IfThenElseZero(f.visible, v.z)};
    };
    const Moments m = LoadMoments(moments + lane);
    const ShapeGradient g = BackThroughShape(camera, f, m);
    V by_direction[3];
    ColorGradient(HarmonicsAt(camera, order, f.mean.x, f.mean.y, f.mean.z), order,
                  p + kGaussiansInBlock * kColorRow, m.rgb, out + kGaussiansInBlock * kColorRow,
                  by_direction);
    const Vector3 direction = {by_direction[0], by_direction[1], by_direction[2]};
    const Vector3 by_mean = kept(Add(RotatedBack(camera, g.p), direction));
    hn::StoreU(by_mean.x, d, out);
    hn::StoreU(by_mean.y, d, out + kGaussiansInBlock);
    hn::StoreU(by_mean.z, d, out + 2 * kGaussiansInBlock);
    StoreShape(camera, f, g, m.sum, p, out);
    const V length = hn::Sqrt(g.ellipse.x * g.ellipse.x + g.ellipse.y * g.ellipse.y);
    hn::StoreU(hn::IfThenElseZero(f.visible, length), d, on_screen + lane);
    if (pose == nullptr) continue;
    const Vector3 axes[3] = {kept(g.axes[0]), kept(g.axes[1]), kept(g.axes[2])};
    AddPose(f, kept(g.p), kept(Rotated(camera, direction)), axes, *pose);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nerf::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nerf::kernels {

HWY_EXPORT(BackwardImpl);

void ProjectGaussiansBackward(const GaussianCamera& camera, int order, std::span<const float> block,
                              const ProjectionGradients& gradients, CameraGradient* pose) {
  HWY_DYNAMIC_DISPATCH(BackwardImpl)
  (camera, order, block.data(), gradients.moments.data(), gradients.parameters.data(),
   gradients.on_screen.data(), pose);
}

}  // namespace nerf::kernels
#endif
