// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <map>
#include <set>
#include <sstream>

#include "support/text.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

/// Every key, each with a unique value that is not the default.
constexpr const char* kEveryKey = R"(
name: full
look: endoscope
bodies:
  - name: organ
    source: mesh
    structure: explicit
    mesh_file: organ.obj
    scan: {file: scan.nrrd, labels: [liver, 5], names_file: names.txt, axes: LPS, transform: qform, volume: 21, series: 1.2}
    unit_scale_m: 0.001
    import_limits: {max_file_mb: 1.5, max_depth: 11, max_instances: 12, max_triangles: 13, other_formats: true}
    up_axis: y
    centered: true
    phantom: gallbladder
    phantom_seed: 103
    phantom_length_m: 0.101
    phantom_wall_scale: 1.02
    box_size_m: [0.031, 0.032, 0.033]
    ball_radius_m: 0.034
    tube: {path: [{position_m: [0.0344, 0.0345, 0.0346]}], radius_m: 0.0347, wall_m: 0.0348, branches: [{name: fork, path: [{position_m: [0.0351, 0.0352, 0.0353]}], radius_m: 0.0354, wall_m: 0.0355}]}
    pressure: {pulse_pa: 3562, pulse_hz: 3.563}
    thickness_m: 0.0035
    bending_ratio: 0.36
    textures: false
    detail_mesh: fine.obj
    skin_faces: 4321
    detail_px: 777
    skin_spacing_m: 0.0007
    roughness: 0.41
    color_variation: 0.42
    specular_wetness: 0.197
    cut_wall_texture: 0.198
    blanching: 0.199
    layers:
      - {depth_m: 0.0043, color: [0.44, 0.45, 0.46], toughness_j_per_m2: 471}
    force_n: [0.37, 0.38, 0.39]
    spacing_m: 0.0041
    target_nodes: 4200
    fill: enclosed
    gap_m: 0.0042
    skin: volume
    mapping: constant
    position_m: [0.051, 0.052, 0.053]
    rotation_deg: [61, 62, 63]
    color: [0.071, 0.072, 0.073]
    material: {tissue: liver, young_modulus_pa: 8100, poisson_ratio: 0.25, density_kg_per_m3: 820, mass_damping_per_s: 8.3, stiffness_damping_ratio: 0.084, weights: cell, law: springs, walls: cells, stiffening: 0, cut: {toughness_j_per_m2: 187},
               bleeding: {flow_ml_per_min: 191, calibre_m: 0.0192, fluid: bile, volume_ml: 19.3}}
    parts: [{part: valve, color: [0.074, 0.075, 0.076], tissue: spleen, young_modulus_pa: 8101, poisson_ratio: 0.25, density_kg_per_m3: 821, cut: {toughness_j_per_m2: 188},
             bleeding: {flow_ml_per_min: 193, calibre_m: 0.0194, fluid: blood, volume_ml: 19.5}}]
    fixed:
      - shape: part
        min_m: [-0.11, -0.12, -0.13]
        max_m: [0.14, 0.15, 0.16]
        center_m: [0.17, 0.18, 0.19]
        radius_m: 0.21
        point_m: [0.22, 0.23, 0.24]
        normal: [0.25, 0.26, 0.27]
        part: septum
styluses:
  - name: left
    idle: grab
    button1: cut
    button2: cut_particles
    shaft_length_m: 0.0611
    trocar: {follows: handle, position_m: [0.0112, 0.0113, 0.0114]}
    shaft_radius_m: 0.00611
    shaft_contact: true
    probe: {radius_m: 0.0061}
    grab: {radius_m: 0.0062, release_speed_m_per_s: 0.65}
    cut: {blade_length_m: 0.063, blade_side: both, friction_n_per_m: 6.31, point_width_m: 0.0631}
    cut_particles: {eraser_radius_m: 0.0064}
    suction: {radius_m: 0.0066, max_force_n: 6.7, release_speed_m_per_s: 0.651}
    scissors: {blade_length_m: 0.0161, opening_deg: 41.7, closing_s: 0.671}
    grasper: {radius_m: 0.0067, jaw_length_m: 0.0171, opening_deg: 41, max_force_n: 6.71, release_speed_m_per_s: 0.652}
    clip: {jaw_length_m: 0.0162, opening_m: 0.0163, width_m: 0.0021, gap_m: 0.00061, force_n: 6.72, magazine: 17}
    cautery: {radius_m: 0.0027, power_w: 41}
    jaw_closing_s: 0.31
    max_force_n: 6.6
    max_force_rate_n_per_s: 670
    max_torque_nm: 0.67
    max_torque_rate_nm_per_s: 6.71
    stale_after_s: 0.68
    workspace_m: 0.69
cameras:
  - name: eye
    position_m: [0.71, 0.72, 0.73]
    target_m: [0.74, 0.75, 0.76]
    up: [0.77, 0.78, 0.79]
    vertical_fov_deg: 45
    width_px: 333
    height_px: 222
    rate_hz: 12
    supersampling: 1
    overlays: [springs, wind]
    strain_range: 0.82
    draw_hidden: true
    frame: scope
    stereo_baseline_m: 0.004
    distortion: {k1: 0.00191, k2: 0.00192, p1: 0.00193, p2: 0.00194, k3: 0.00195}
    light: lens
    light_cone_deg: 95.5
    contact_shadows: 0.196
environment:
  gravity_m_per_s2: [1.1, 1.2, 1.3]
  world_frame: room
  tissue_frame: table
  tissue_position_m: [1.4, 1.5, 1.6]
  tissue_rotation_deg: [17, 18, 19]
  scan_origin_m: [0.71, 0.72, 0.73]
  wind: {velocity_m_per_s: [2.1, 2.2, 2.3], gust_ratio: 0.24, gust_period_s: 2.5, air_density_kg_per_m3: 1.26, drag_coefficient: 0.27}
collision: {enabled: true, distance_m: 0.028, friction: 0.29, restitution: 0.301}
obstacles:
  - name: table
    shape: capsule
    position_m: [0.31, 0.32, 0.33]
    rotation_deg: [34, 35, 36]
    radius_m: 0.037
    length_m: 0.38
    size_m: [0.39, 0.401, 0.402]
    velocity_m_per_s: [0.403, 0.404, 0.405]
    rotation_deg_per_s: [406, 407, 408]
    frame: arm
    friction: 0.409
    restitution: 0.411
marks:
  - {body: organ, kind: ring, path: [{position_m: [0.414, 0.415, 0.416]}], center_m: [0.417, 0.418, 0.419],
     normal: [0.421, 0.422, 0.423], radius_m: 0.0424, width_m: 0.00425, color: [0.426, 0.427, 0.428], pattern: crossed}
solver: {tick_hz: 90, integrator: leapfrog, dt_fraction: 0.91, dt_fraction_strained: 0.41, measured_limit: false, start: equilibrium, substeps: 93, iterations: 94,
         compensated: true, stability_monitor: false, recovery_s: 0.95, sleep_distance_m: 0.96, sleep_speed_m_per_s: 0.0097, max_substeps: 92,
         device: 3, backend: cpu, threads: 2, real_time_factor: 1.97}
sutures:
  - {name: suture, material: silk, usp: 5-0, radius_m: 0.00012, young_modulus_pa: 1.3e9, density_kg_per_m3: 1400, bending_share: 0.15, mass_damping_per_s: 1.6,
     length_m: 0.17, spacing_m: 0.0018, position_m: [0.19, 0.21, 0.22], path: [{position_m: [0.23, 0.24, 0.25]}], start: free, end: fixed,
     channels: [{body: liver, position_m: [0.26, 0.27, 0.28]}], friction: 0.29, through_n_per_m: 0.31, pull_out_n: 0.32, tissue: fascia, bite_m: 0.033,
     depth_m: 0.034, ties: [{at_s: 1.41, knot: granny, tension_n: 0.241, holds_n: 2.41, to: strand, strand_m: [0.0241, 0.0242, 0.0243]}],
     needle: {arc: three_eighths, radius_m: 0.0091, wire_radius_m: 0.00036, puncture_n: 0.92, cutting_n: 0.31, friction_n_per_m: 12.5,
              rotation_deg: [13, 14, 15]}}
)";

/// Keys that the structure above does not accept.
constexpr const char* kOfLatticesAlone = R"(
bodies:
  - material: {poisson_ratio: 0.31, law: neo_hookean, stiffening: 4.3, tear: {toughness_j_per_m2: 189},
               prestress: {strain: 0.0821, strains: [0.0822, 0.0823, 0.0824], axes_deg: [82.5, 82.6, 82.7]}}
    pressure: {mean_pa: 3561}
    parts: [{part: valve, poisson_ratio: 0.32,
             prestress: {strain: 0.0831, strains: [0.0832, 0.0833, 0.0834], axes_deg: [83.5, 83.6, 83.7]}}]
  - {name: bed}
attachments:
  - {body_a: tissue, body_b: bed, reach_m: 0.00151, modulus_pa: 1520, thickness_m: 0.00153, toughness_j_per_m2: 15.4,
     strength_pa: 1550}
styluses: [{name: laparoscope}]
cameras: [{stylus: laparoscope, lens_angle_deg: 31}]
)";

/// Collects the paths of all keys below a node, list items as name[].
void collectPaths(const YAML::Node& node, const std::string& path, std::multiset<std::string>& paths) {
  for (const auto& entry : node) {
    const std::string key = path + entry.first.as<std::string>();
    paths.insert(key);
    if (entry.second.IsMap()) collectPaths(entry.second, key + ".", paths);
    if (!entry.second.IsSequence() || !entry.second[0].IsMap()) continue;
    for (const YAML::Node& item : entry.second) collectPaths(item, key + "[].", paths);
  }
}

/// Returns the cells of the rows of a Markdown table, without its head.
std::vector<std::vector<std::string>> tableRows(const std::string& table) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::vector<std::string> row;
    for (std::string cell; std::getline(cells, cell, '|');) row.push_back(cell);
    rows.push_back(row);
  }
  rows.erase(rows.begin(), rows.begin() + 2);
  return rows;
}

TEST(SceneKeys, EveryBodyKeyReachesItsField) {
  const BodyConfig body = parseScene(kEveryKey, "full").bodies.at(0);
  EXPECT_EQ(body.name, "organ");
  EXPECT_EQ(body.source, TissueSource::kMesh);
  EXPECT_EQ(body.structure, Structure::kExplicit);
  EXPECT_EQ(body.mesh_file, "organ.obj");
  EXPECT_EQ(body.tube.path.at(0).position_m, Vector3d(0.0344, 0.0345, 0.0346));
  EXPECT_EQ(body.tube.radius_m, 0.0347);
  EXPECT_EQ(body.tube.wall_m, 0.0348);
  EXPECT_EQ(body.tube.branches.at(0).name, "fork");
  EXPECT_EQ(body.tube.branches.at(0).path.at(0).position_m, Vector3d(0.0351, 0.0352, 0.0353));
  EXPECT_EQ(body.tube.branches.at(0).radius_m, 0.0354);
  EXPECT_EQ(body.tube.branches.at(0).wall_m, 0.0355);
  EXPECT_EQ(body.pressure.pulse_pa, 3562);
  EXPECT_EQ(body.pressure.pulse_hz, 3.563);
  EXPECT_EQ(parseScene(kOfLatticesAlone, "lattices").bodies.at(0).pressure.mean_pa, 3561);
  EXPECT_EQ(body.scan.file, "scan.nrrd");
  EXPECT_EQ(body.scan.labels, (std::vector<std::string>{"liver", "5"}));
  EXPECT_EQ(body.scan.names_file, "names.txt");
  EXPECT_EQ(body.scan.axes, "LPS");
  EXPECT_EQ(body.scan.transform, "qform");
  EXPECT_EQ(body.scan.volume, 21);
  EXPECT_EQ(body.scan.series, "1.2");
  EXPECT_EQ(body.unit_scale_m, 0.001);
  EXPECT_EQ(body.import_limits.max_file_mb, 1.5);
  EXPECT_EQ(body.import_limits.max_depth, 11);
  EXPECT_EQ(body.import_limits.max_instances, 12);
  EXPECT_EQ(body.import_limits.max_triangles, 13);
  EXPECT_TRUE(body.import_limits.other_formats);
  EXPECT_EQ(body.up_axis, UpAxis::kY);
  EXPECT_TRUE(body.centered);
  EXPECT_EQ(body.phantom, Anatomy::kGallbladder);
  EXPECT_EQ(body.phantom_seed, 103);
  EXPECT_EQ(body.phantom_length_m, 0.101);
  EXPECT_EQ(body.phantom_wall_scale, 1.02);
  EXPECT_EQ(body.box_size_m, Vector3d(0.031, 0.032, 0.033));
  EXPECT_EQ(body.ball_radius_m, 0.034);
  EXPECT_EQ(body.thickness_m, 0.0035);
  EXPECT_EQ(body.bending_ratio, 0.36);
  EXPECT_FALSE(body.textures);
  EXPECT_EQ(body.detail_mesh, "fine.obj");
  EXPECT_EQ(body.skin_faces, 4321);
  EXPECT_EQ(body.detail_px, 777);
  EXPECT_EQ(body.skin_spacing_m, 0.0007);
  EXPECT_EQ(body.roughness, 0.41);
  EXPECT_EQ(body.color_variation, 0.42);
  ASSERT_EQ(body.layers.size(), 1u);
  EXPECT_EQ(body.layers[0].depth_m, 0.0043);
  EXPECT_EQ(body.layers[0].color, Vector3d(0.44, 0.45, 0.46));
  EXPECT_EQ(body.layers[0].toughness_j_per_m2, 471);
  EXPECT_EQ(body.force_n, Vector3d(0.37, 0.38, 0.39));
  EXPECT_EQ(body.spacing_m, 0.0041);
  EXPECT_EQ(body.target_nodes, 4200);
  EXPECT_EQ(body.skin, SkinSource::kVolume);
  EXPECT_EQ(body.mapping, Mapping::kConstant);
  EXPECT_EQ(body.position_m, Vector3d(0.051, 0.052, 0.053));
  EXPECT_EQ(body.rotation_deg, Vector3d(61, 62, 63));
  EXPECT_EQ(body.color, Vector3d(0.071, 0.072, 0.073));
  EXPECT_EQ(body.material.tissue, "liver");
  EXPECT_EQ(body.material.young_modulus_pa, 8100);
  EXPECT_EQ(body.material.density_kg_per_m3, 820);
  EXPECT_EQ(body.material.mass_damping_per_s, 8.3);
  EXPECT_EQ(body.material.stiffness_damping_ratio, 0.084);
  EXPECT_EQ(body.material.cut.toughness_j_per_m2, 187);
  EXPECT_EQ(body.material.bleeding.flow_ml_per_min, 191);
  EXPECT_EQ(body.material.bleeding.calibre_m, 0.0192);
  EXPECT_EQ(body.material.bleeding.fluid, Fluid::kBile);
  EXPECT_EQ(body.material.bleeding.volume_ml, 19.3);
  EXPECT_EQ(body.material.weights, Weights::kCell);
  EXPECT_EQ(body.material.law, Law::kSprings);
  EXPECT_EQ(body.material.stiffening, 0);
  const PartConfig& part = body.parts.at(0);
  EXPECT_EQ(part.cut.toughness_j_per_m2, 188);
  EXPECT_EQ(part.part, "valve");
  EXPECT_EQ(part.tissue, "spleen");
  EXPECT_EQ(part.color, Vector3d(0.074, 0.075, 0.076));
  EXPECT_EQ(part.young_modulus_pa, 8101);
  EXPECT_EQ(part.density_kg_per_m3, 821);
  EXPECT_EQ(part.bleeding.flow_ml_per_min, 193);
  EXPECT_EQ(part.bleeding.calibre_m, 0.0194);
  EXPECT_EQ(part.bleeding.fluid, Fluid::kBlood);
  EXPECT_EQ(part.bleeding.volume_ml, 19.5);
  const FixedConfig& fixed = body.fixed.at(0);
  EXPECT_EQ(fixed.shape, FixedShape::kPart);
  EXPECT_EQ(fixed.min_m, Vector3d(-0.11, -0.12, -0.13));
  EXPECT_EQ(fixed.max_m, Vector3d(0.14, 0.15, 0.16));
  EXPECT_EQ(fixed.center_m, Vector3d(0.17, 0.18, 0.19));
  EXPECT_EQ(fixed.radius_m, 0.21);
  EXPECT_EQ(fixed.point_m, Vector3d(0.22, 0.23, 0.24));
  EXPECT_EQ(fixed.normal, Vector3d(0.25, 0.26, 0.27));
  EXPECT_EQ(fixed.part, "septum");
}

TEST(SceneKeys, EveryKeyOfLatticesAloneReachesItsField) {
  const BodyConfig body = parseScene(kOfLatticesAlone, "lattice").bodies.at(0);
  EXPECT_EQ(body.material.poisson_ratio, 0.31);
  EXPECT_EQ(body.material.law, Law::kNeoHookean);
  EXPECT_EQ(body.material.stiffening, 4.3);
  EXPECT_EQ(body.material.tear.toughness_j_per_m2, 189);
  EXPECT_EQ(body.material.prestress.strain, 0.0821);
  EXPECT_EQ(body.material.prestress.strains, Vector3d(0.0822, 0.0823, 0.0824));
  EXPECT_EQ(body.material.prestress.axes_deg, Vector3d(82.5, 82.6, 82.7));
  const PartConfig& part = body.parts.at(0);
  EXPECT_EQ(part.poisson_ratio, 0.32);
  EXPECT_EQ(part.prestress.strain, 0.0831);
  EXPECT_EQ(part.prestress.strains, Vector3d(0.0832, 0.0833, 0.0834));
  EXPECT_EQ(part.prestress.axes_deg, Vector3d(83.5, 83.6, 83.7));
}

TEST(SceneKeys, EveryKeyOfAttachmentsReachesItsField) {
  const AttachmentConfig attachment = parseScene(kOfLatticesAlone, "lattice").attachments.at(0);
  EXPECT_EQ(attachment.body_a, "tissue");
  EXPECT_EQ(attachment.body_b, "bed");
  EXPECT_EQ(attachment.reach_m, 0.00151);
  EXPECT_EQ(attachment.modulus_pa, 1520);
  EXPECT_EQ(attachment.thickness_m, 0.00153);
  EXPECT_EQ(attachment.toughness_j_per_m2, 15.4);
  EXPECT_EQ(attachment.strength_pa, 1550);
}

TEST(SceneKeys, EveryKeyOfEndoscopesReachesItsField) {
  const CameraConfig camera = parseScene(kOfLatticesAlone, "lattice").cameras.at(0);
  EXPECT_EQ(camera.stylus, "laparoscope");
  EXPECT_EQ(camera.lens_angle_deg, 31);
}

TEST(SceneKeys, PapersWeightsGoWithSprings) {
  const MaterialConfig paper =
      parseScene("{bodies: [{material: {weights: paper, law: springs}}]}", "paper").bodies.at(0).material;
  EXPECT_EQ(paper.weights, Weights::kPaper);
  EXPECT_EQ(paper.law, Law::kSprings);
}

TEST(SceneKeys, EveryOtherKeyReachesItsField) {
  const Scene scene = parseScene(kEveryKey, "full");
  EXPECT_EQ(scene.name, "full");
  EXPECT_EQ(scene.look, Look::kEndoscope);
  const StylusConfig& stylus = scene.styluses.at(0);
  EXPECT_EQ(stylus.name, "left");
  EXPECT_EQ(stylus.idle, ToolMode::kGrab);
  EXPECT_EQ(stylus.button1, ToolMode::kCut);
  EXPECT_EQ(stylus.button2, ToolMode::kCutParticles);
  EXPECT_EQ(stylus.probe.radius_m, 0.0061);
  EXPECT_EQ(stylus.grab.radius_m, 0.0062);
  EXPECT_EQ(stylus.cut.blade_length_m, 0.063);
  EXPECT_EQ(stylus.cut.blade_side, BladeSide::kBoth);
  EXPECT_EQ(stylus.cut.friction_n_per_m, 6.31);
  EXPECT_EQ(stylus.cut.point_width_m, 0.0631);
  EXPECT_EQ(stylus.shaft_length_m, 0.0611);
  EXPECT_EQ(stylus.trocar.follows, TrocarMotion::kHandle);
  EXPECT_EQ(stylus.trocar.position_m, Vector3d(0.0112, 0.0113, 0.0114));
  EXPECT_EQ(stylus.shaft_radius_m, 0.00611);
  EXPECT_TRUE(stylus.shaft_contact);
  EXPECT_EQ(stylus.cut_particles.eraser_radius_m, 0.0064);
  EXPECT_EQ(stylus.grab.release_speed_m_per_s, 0.65);
  EXPECT_EQ(stylus.suction.radius_m, 0.0066);
  EXPECT_EQ(stylus.suction.max_force_n, 6.7);
  EXPECT_EQ(stylus.suction.release_speed_m_per_s, 0.651);
  EXPECT_EQ(stylus.scissors.blade_length_m, 0.0161);
  EXPECT_EQ(stylus.scissors.opening_deg, 41.7);
  EXPECT_EQ(stylus.scissors.closing_s, 0.671);
  EXPECT_EQ(stylus.grasper.radius_m, 0.0067);
  EXPECT_EQ(stylus.grasper.jaw_length_m, 0.0171);
  EXPECT_EQ(stylus.grasper.opening_deg, 41);
  EXPECT_EQ(stylus.grasper.max_force_n, 6.71);
  EXPECT_EQ(stylus.grasper.release_speed_m_per_s, 0.652);
  EXPECT_EQ(stylus.jaw_closing_s, 0.31);
  EXPECT_EQ(stylus.clip.jaw_length_m, 0.0162);
  EXPECT_EQ(stylus.clip.opening_m, 0.0163);
  EXPECT_EQ(stylus.clip.width_m, 0.0021);
  EXPECT_EQ(stylus.clip.gap_m, 0.00061);
  EXPECT_EQ(stylus.clip.force_n, 6.72);
  EXPECT_EQ(stylus.clip.magazine, 17);
  EXPECT_EQ(stylus.cautery.radius_m, 0.0027);
  EXPECT_EQ(stylus.cautery.power_w, 41);
  EXPECT_EQ(stylus.max_force_n, 6.6);
  EXPECT_EQ(stylus.max_force_rate_n_per_s, 670);
  EXPECT_EQ(stylus.max_torque_nm, 0.67);
  EXPECT_EQ(stylus.max_torque_rate_nm_per_s, 6.71);
  EXPECT_EQ(stylus.stale_after_s, 0.68);
  EXPECT_EQ(stylus.workspace_m, 0.69);
  const CameraConfig& camera = scene.cameras.at(0);
  EXPECT_EQ(camera.name, "eye");
  EXPECT_EQ(camera.position_m, Vector3d(0.71, 0.72, 0.73));
  EXPECT_EQ(camera.target_m, Vector3d(0.74, 0.75, 0.76));
  EXPECT_EQ(camera.up, Vector3d(0.77, 0.78, 0.79));
  EXPECT_EQ(camera.vertical_fov_deg, 45);
  EXPECT_EQ(camera.width_px, 333);
  EXPECT_EQ(camera.height_px, 222);
  EXPECT_EQ(camera.rate_hz, 12);
  EXPECT_EQ(camera.supersampling, 1);
  EXPECT_TRUE(camera.overlays == overlaysOf({"wind", "springs"}));
  EXPECT_EQ(camera.strain_range, 0.82);
  EXPECT_TRUE(camera.draw_hidden);
  EXPECT_EQ(camera.frame, "scope");
  EXPECT_EQ(camera.stereo_baseline_m, 0.004);
  EXPECT_EQ(scene.environment.gravity_m_per_s2, Vector3d(1.1, 1.2, 1.3));
  EXPECT_EQ(scene.environment.world_frame, "room");
  EXPECT_EQ(scene.environment.tissue_frame, "table");
  EXPECT_EQ(scene.environment.tissue_position_m, Vector3d(1.4, 1.5, 1.6));
  EXPECT_EQ(scene.environment.tissue_rotation_deg, Vector3d(17, 18, 19));
  EXPECT_EQ(scene.environment.scan_origin_m, Vector3d(0.71, 0.72, 0.73));
  EXPECT_EQ(scene.solver.tick_hz, 90);
  EXPECT_EQ(parseScene("{bodies: [{}], solver: {integrator: pd}}", "pd").solver.integrator, Integrator::kPd);
  EXPECT_EQ(scene.solver.dt_fraction, 0.91);
  EXPECT_EQ(scene.solver.dt_fraction_strained, 0.41);
  EXPECT_FALSE(scene.solver.measured_limit);
  EXPECT_EQ(scene.solver.start, SolverStart::kEquilibrium);
  EXPECT_EQ(scene.solver.substeps, 93);
  EXPECT_EQ(scene.solver.iterations, 94);
  EXPECT_TRUE(scene.solver.compensated);
  EXPECT_FALSE(scene.solver.stability_monitor);
  EXPECT_EQ(scene.solver.recovery_s, 0.95);
  EXPECT_EQ(scene.solver.sleep_distance_m, 0.96);
  EXPECT_EQ(scene.solver.max_substeps, 92);
  EXPECT_EQ(scene.solver.device, 3);
  EXPECT_EQ(scene.solver.real_time_factor, 1.97);
}

TEST(SceneKeys, EveryKeyOfTheEnvironmentReachesItsField) {
  const Scene scene = parseScene(kEveryKey, "full");
  const WindConfig& wind = scene.environment.wind;
  EXPECT_EQ(wind.velocity_m_per_s, Vector3d(2.1, 2.2, 2.3));
  EXPECT_EQ(wind.gust_ratio, 0.24);
  EXPECT_EQ(wind.gust_period_s, 2.5);
  EXPECT_EQ(wind.air_density_kg_per_m3, 1.26);
  EXPECT_EQ(wind.drag_coefficient, 0.27);
  const CollisionConfig& collision = scene.collision;
  EXPECT_TRUE(collision.enabled);
  EXPECT_EQ(collision.distance_m, 0.028);
  EXPECT_EQ(collision.friction, 0.29);
  EXPECT_EQ(collision.restitution, 0.301);
  const ObstacleConfig& obstacle = scene.obstacles.at(0);
  EXPECT_EQ(obstacle.name, "table");
  EXPECT_EQ(obstacle.shape, ObstacleShape::kCapsule);
  EXPECT_EQ(obstacle.position_m, Vector3d(0.31, 0.32, 0.33));
  EXPECT_EQ(obstacle.rotation_deg, Vector3d(34, 35, 36));
  EXPECT_EQ(obstacle.radius_m, 0.037);
  EXPECT_EQ(obstacle.length_m, 0.38);
  EXPECT_EQ(obstacle.size_m, Vector3d(0.39, 0.401, 0.402));
  EXPECT_EQ(obstacle.velocity_m_per_s, Vector3d(0.403, 0.404, 0.405));
  EXPECT_EQ(obstacle.rotation_deg_per_s, Vector3d(406, 407, 408));
  EXPECT_EQ(obstacle.frame, "arm");
  EXPECT_EQ(obstacle.friction, 0.409);
  EXPECT_EQ(obstacle.restitution, 0.411);
  const MarkConfig& mark = scene.marks.at(0);
  EXPECT_EQ(mark.body, "organ");
  EXPECT_EQ(mark.kind, MarkKind::kRing);
  EXPECT_EQ(mark.path.at(0).position_m, Vector3d(0.414, 0.415, 0.416));
  EXPECT_EQ(mark.center_m, Vector3d(0.417, 0.418, 0.419));
  EXPECT_EQ(mark.normal, Vector3d(0.421, 0.422, 0.423));
  EXPECT_EQ(mark.radius_m, 0.0424);
  EXPECT_EQ(mark.width_m, 0.00425);
  EXPECT_EQ(mark.color, Vector3d(0.426, 0.427, 0.428));
  EXPECT_EQ(mark.pattern, MarkPattern::kCrossed);
  const SutureConfig& suture = scene.sutures.at(0);
  EXPECT_EQ(suture.name, "suture");
  EXPECT_EQ(suture.material, SutureMaterial::kSilk);
  EXPECT_EQ(suture.usp, SutureSize::kUsp5);
  EXPECT_EQ(suture.radius_m, 0.00012);
  EXPECT_EQ(suture.young_modulus_pa, 1.3e9);
  EXPECT_EQ(suture.density_kg_per_m3, 1400);
  EXPECT_EQ(suture.bending_share, 0.15);
  EXPECT_EQ(suture.mass_damping_per_s, 1.6);
  EXPECT_EQ(suture.length_m, 0.17);
  EXPECT_EQ(suture.spacing_m, 0.0018);
  EXPECT_EQ(suture.position_m, Vector3d(0.19, 0.21, 0.22));
  EXPECT_EQ(suture.path.at(0).position_m, Vector3d(0.23, 0.24, 0.25));
  EXPECT_EQ(suture.start, SutureEnd::kFree);
  EXPECT_EQ(suture.end, SutureEnd::kFixed);
  EXPECT_EQ(suture.channels.at(0).body, "liver");
  EXPECT_EQ(suture.ties.at(0).at_s, 1.41);
  EXPECT_EQ(suture.ties.at(0).knot, KnotKind::kGranny);
  EXPECT_EQ(suture.ties.at(0).tension_n, 0.241);
  EXPECT_EQ(suture.ties.at(0).holds_n, 2.41);
  EXPECT_EQ(suture.ties.at(0).to, TieTo::kStrand);
  EXPECT_EQ(suture.ties.at(0).strand_m, Vector3d(0.0241, 0.0242, 0.0243));
  EXPECT_EQ(suture.channels.at(0).position_m, Vector3d(0.26, 0.27, 0.28));
  EXPECT_EQ(suture.friction, 0.29);
  EXPECT_EQ(suture.through_n_per_m, 0.31);
  EXPECT_EQ(suture.pull_out_n, 0.32);
  EXPECT_EQ(suture.tissue, StitchedTissue::kFascia);
  EXPECT_EQ(suture.bite_m, 0.033);
  EXPECT_EQ(suture.depth_m, 0.034);
  const NeedleConfig& needle = suture.needle;
  EXPECT_EQ(needle.arc, NeedleArc::kThreeEighths);
  EXPECT_EQ(needle.radius_m, 0.0091);
  EXPECT_EQ(needle.wire_radius_m, 0.00036);
  EXPECT_EQ(needle.puncture_n, 0.92);
  EXPECT_EQ(needle.cutting_n, 0.31);
  EXPECT_EQ(needle.friction_n_per_m, 12.5);
  EXPECT_EQ(needle.rotation_deg, Vector3d(13, 14, 15));
}

TEST(SceneKeys, TableHoldsEveryKeyOnceAndNoOther) {
  std::multiset<std::string> accepted, of_lattices, listed;
  collectPaths(YAML::Load(kEveryKey), "", accepted);
  collectPaths(YAML::Load(kOfLatticesAlone), "", of_lattices);
  for (const std::string& key : of_lattices)
    if (accepted.count(key) == 0) accepted.insert(key);
  for (const auto& row : tableRows(sceneKeysTable())) listed.insert(row.at(1).substr(2, row.at(1).size() - 4));
  for (const std::string& key : accepted) EXPECT_EQ(listed.count(key), 1u) << key;
  for (const std::string& key : listed) EXPECT_EQ(accepted.count(key), 1u) << key << " is missing in this test's scene";
}

TEST(SceneKeys, EveryRowIsComplete) {
  for (const auto& row : tableRows(sceneKeysTable())) {
    ASSERT_EQ(row.size(), 6u) << row.at(1);  // nothing precedes the first bar
    EXPECT_GT(row[2].size(), 2u) << row[1] << " has no type";
    EXPECT_GT(row[5].size(), 2u) << row[1] << " has no meaning";
    const bool ranged = row[2] != " text " && row[2] != " map " && row[2] != " true or false ";
    EXPECT_EQ(row[4].find_first_not_of(' ') != std::string::npos, ranged) << row[1] << row[4];
  }
}

TEST(SceneKeys, KeyEndsInItsUnit) {
  const std::map<std::string, std::string> suffixes = {{"m", "_m"},
                                                       {"Pa", "_pa"},
                                                       {"kg/m3", "_kg_per_m3"},
                                                       {"1/s", "_per_s"},
                                                       {"m/s", "_m_per_s"},
                                                       {"m/s2", "_m_per_s2"},
                                                       {"N", "_n"},
                                                       {"N/s", "_n_per_s"},
                                                       {"s", "_s"},
                                                       {"deg", "_deg"},
                                                       {"Hz", "_hz"},
                                                       {"deg/s", "_deg_per_s"},
                                                       {"MB", "_mb"},
                                                       {"N m", "_nm"},
                                                       {"N m/s", "_nm_per_s"},
                                                       {"J/m2", "_j_per_m2"},
                                                       {"N/m", "_n_per_m"},
                                                       {"W", "_w"},
                                                       {"ml", "_ml"},
                                                       {"ml/min", "_ml_per_min"}};
  for (const auto& row : tableRows(sceneKeysTable())) {
    const size_t comma = row.at(2).find(", ");
    if (comma == std::string::npos) continue;
    const std::string unit = row[2].substr(comma + 2, row[2].size() - comma - 3),
                      key = row[1].substr(0, row[1].size() - 2);
    ASSERT_TRUE(suffixes.count(unit)) << key << " is in " << unit;
    const std::string& suffix = suffixes.at(unit);
    EXPECT_EQ(key.substr(key.size() - suffix.size()), suffix) << key << " is in " << unit;
  }
}

}  // namespace
}  // namespace viscera
