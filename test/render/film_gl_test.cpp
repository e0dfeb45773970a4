// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// The film of fluid on wet tissue (docs/surface.md, Looks) is fixed to the rest positions of the tissue.
#include <cstdlib>

#include "render/drawing.h"
#include "viscera/model/model.h"

using namespace viscera;

namespace {

constexpr int kSameShade = 3;     ///< of 255: rounding of normals to 10 bits
constexpr double kSame = 0.99;    ///< least share of equal pixels: those at edges of triangles may be rounded to others
constexpr double kOthers = 0.15;  ///< least share of pixels in which the film shows

class FilmGl : public Drawing {
 protected:
  FilmGl() {
    model_.bodies.emplace_back();
    camera_.position_m = Vector3d(0, -0.2, 0);
  }
  /// Draws a bent wall of tissue.
  /// @param pose  its current pose
  /// @param along_m  shift of its rest positions
  Image drawn(double specular_wetness, const Pose& pose = {}, double along_m = 0) {
    constexpr int kAcross = 40;
    std::vector<Vector3f> points, normals;
    std::vector<uint32_t> triangles;
    std::vector<layout::vec4> rests;
    for (uint32_t j = 0; j <= kAcross; ++j) {
      for (uint32_t i = 0; i <= kAcross; ++i) {
        const double angle = 1.5 * i / kAcross - 0.75;
        const Vector3d out(std::sin(angle), -std::cos(angle), 0);
        const Vector3d at = 0.06 * out + Vector3d(0, 0.06, 0.1 * j / kAcross - 0.05);
        points.push_back((pose * at).cast<float>());
        normals.push_back((pose.orientation * out).cast<float>());
        const Vector3f rest = (at + Vector3d(0, 0, along_m)).cast<float>();
        rests.push_back({rest.x(), rest.y(), rest.z(), 0});
        if (i == kAcross || j == kAcross) continue;
        const uint32_t a = j * (kAcross + 1) + i, b = a + kAcross + 1;
        triangles.insert(triangles.end(), {a, a + 1, b + 1, a, b + 1, b});
      }
    }
    const GpuMesh mesh(points, normals, triangles);
    const gpu::Buffer<layout::vec4> at_rest(rests);
    MeshView view = mesh.view();
    view.rests = at_rest.id();
    model_.bodies[0].specular_wetness = specular_wetness;
    Renderer renderer({camera_}, styluses_, {}, &model_);
    renderer.placeCamera(0, pose * opticalPose(camera_));
    return draw(renderer, view);
  }
  /// Returns the share of equal pixels in two pictures.
  static double alike(const Image& a, const Image& b) {
    size_t same = 0;
    for (size_t i = 0; i < a.rgb.size(); i += 3) {
      int most = 0;
      for (size_t k = i; k < i + 3; ++k) most = std::max(most, std::abs(a.rgb[k] - b.rgb[k]));
      same += most <= kSameShade ? 1 : 0;
    }
    return 3.0 * static_cast<double>(same) / static_cast<double>(a.rgb.size());
  }

  Model model_;
};

}  // namespace

TEST_F(FilmGl, IsSeenAndGoesWithTheTissue) {
  const Pose moved = {Vector3d(0.3, -0.2, 0.1), Quaterniond(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()))};
  for (const int supersampling : {0, 2}) {
    camera_.supersampling = supersampling;
    const Image wet = drawn(0.5);
    EXPECT_LT(alike(wet, drawn(0)), 1 - kOthers) << supersampling;
    EXPECT_LT(alike(wet, drawn(1)), 1 - kOthers) << supersampling;
    EXPECT_GT(alike(wet, drawn(0.5, moved)), kSame) << supersampling << ": the eye goes with the tissue";
    EXPECT_LT(alike(wet, drawn(0.5, {}, 0.006)), 1 - kOthers) << supersampling << ": other tissue in the same place";
  }
}
