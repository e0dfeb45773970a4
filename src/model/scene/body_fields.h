// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "model/scene/field_ranges.h"
#include "model/scene/mark_fields.h"
#include "viscera/model/scene/body_config.h"

namespace viscera {

// Scene keys of bodies (scene_fields.h).

constexpr int kMostLayers = 4;
constexpr int kMostLabels = 255;
constexpr Range kToughness{0, 1e6};  // J/m2

template <class V>
void visitFields(V& v, FixedConfig& c) {
  v.choice(
      "shape", c.shape,
      {{"box", FixedShape::kBox},
       {"sphere", FixedShape::kSphere},
       {"plane", FixedShape::kPlane},
       {"part", FixedShape::kPart}},
      "shape of the region that holds its nodes in space, in the body's own coordinates, before its pose. With "
      "material.law: neo_hookean, nodes within half a cell of it are held too, on its border only those of faces that "
      "tissue reaches, and the lattice has nodes on a plane of the region that is parallel to it (docs/volumes.md)");
  v.vector("min_m", c.min_m, kCoordinate, "m", "box: lower corner");
  v.vector("max_m", c.max_m, kCoordinate, "m", "box: upper corner");
  v.vector("center_m", c.center_m, kCoordinate, "m", "sphere: centre");
  v.number("radius_m", c.radius_m, kLength, "m", "sphere: radius");
  v.vector("point_m", c.point_m, kCoordinate, "m", "plane: a point on it");
  v.vector("normal", c.normal, kDirection, "", "plane: normal; nodes on the side that it points away from are held");
  v.text("part", c.part, "part: name of a part of the mesh or phantom, or of a label");
}

template <class V>
void visitFields(V& v, FractureConfig& c) {
  v.numberOrAuto("toughness_j_per_m2", c.toughness_j_per_m2, c.of_tissue, kToughness, "J/m2",
                 "fracture toughness: work of a blade per area that it cuts, felt at the stylus (docs/cutting.md); 0: "
                 "a blade cuts all that it crosses and is not felt; auto: that of the tissue "
                 "(docs/tissues.md#toughness). Above 0: needs solver.integrator leapfrog");
}

template <class V>
void visitFields(V& v, PrestressConfig& c) {
  constexpr Range kPrestrain{-0.3, 0.5};
  v.number("strain", c.strain, kPrestrain, "1",
           "prestrain: fraction of its length by which tissue would be shorter along any axis if nothing held it; with "
           "structure surface, along the surface (docs/physics.md 11)");
  v.vector("strains", c.strains, kPrestrain, "1", "prestrain along each of three axes, added to `strain`");
  v.vector("axes_deg", c.axes_deg, kAngle, "deg",
           "rotation of the axes of `strains` from the tissue frame's: turns about the fixed x, then y, then z axis");
}

template <class V>
void visitFields(V& v, TearConfig& c) {
  v.number("toughness_j_per_m2", c.toughness_j_per_m2, {0, 1e6}, "J/m2",
           "tear toughness: work per area that it takes to pull the tissue apart (docs/physics.md 12); 0: it stretches "
           "without limit. Above 0: needs structure lattice, solver.integrator leapfrog, solver.backend cpu or auto");
}

template <class V>
void visitFields(V& v, BleedingConfig& c) {
  v.number("flow_ml_per_min", c.flow_ml_per_min, {0, 1e4}, "ml/min",
           "flow of `fluid` from a stump that is cut clean through; a smaller wound leaks by its share of the cross "
           "section (docs/lessons/instruments.md); 0: no bleeding, and no cost");
  v.number("calibre_m", c.calibre_m, {0, 1}, "m",
           "diameter of a vessel with that flow; 0: from the volume of the part over the distance between its ends, "
           "which is wrong for a part that bends or branches");
  v.choice("fluid", c.fluid, {{"blood", Fluid::kBlood}, {"bile", Fluid::kBile}},
           "fluid that leaves a cut: parts with different fluids are separate vessels");
  v.number("volume_ml", c.volume_ml, {0, 1e5}, "ml",
           "fluid in the part: flows fall in proportion to what is left in connected parts; 0 in all of them: no end");
}

template <class V>
void visitFields(V& v, MaterialConfig& c) {
  v.tissue("tissue", c,
           "preset of tissue properties: gives those of the three keys below that the scene does not give; not for "
           "diagnosis or planning");
  v.number("young_modulus_pa", c.young_modulus_pa, {1, 1e9}, "Pa", "Young's modulus E");
  v.number("poisson_ratio", c.poisson_ratio, {0, 0.49}, "1",
           "Poisson's ratio nu; law springs supports 1/4 only; structure surface has that of its springs, 1/3");
  v.number("density_kg_per_m3", c.density_kg_per_m3, {1, 1e5}, "kg/m3", "mass density");
  v.number("mass_damping_per_s", c.mass_damping_per_s, {0, 1e4}, "1/s",
           "mass-proportional damping rate gamma: every velocity decays at this rate");
  v.number("stiffness_damping_ratio", c.stiffness_damping_ratio, {0, 0.5}, "1",
           "stiffness-proportional damping ratio of axial springs, at the highest frequency; 0: no such damping, which "
           "the kernel then omits");
  v.choice("weights", c.weights, {{"cell", Weights::kCell}, {"paper", Weights::kPaper}},
           "assembly of springs and masses: per solid cell (exact), or with VR05's uniform weights");
  v.choice("law", c.law, {{"auto", Law::kAuto}, {"neo_hookean", Law::kNeoHookean}, {"springs", Law::kSprings}},
           "material law of the cells: neo_hookean is accurate at large strain and fills cells at the surface in part "
           "(structure lattice, solver.integrator leapfrog); springs is that of the papers, with cells full or empty; "
           "auto is neo_hookean for structure lattice with integrator leapfrog and weights cell, else springs");
  v.choice("walls", c.walls, {{"cells", Walls::kCells}, {"rows", Walls::kRows}},
           "law neo_hookean: bending model of walls below three cells that are oblique to the lattice: cells uses the "
           "corners of their cells; rows uses rows of nodes, with a seventh to a half of the error, at about twice the "
           "time for such cells (docs/physics.md#thin-walls, docs/material.md)");
  v.numberOrAuto("stiffening", c.stiffening, c.stiffens_as_tissue, {0, 100}, "1",
                 "law neo_hookean: b of the shear energy mu/(2 b) (exp(b (I1 - 3)) - 1), by which tissue stiffens as "
                 "it is stretched: by exp(b (I1 - 3)), at most 20 times; 0: no stiffening, and no cost; auto: that of "
                 "the tissue (docs/tissues.md#stiffening)");
  v.group("cut", c.cut, "resistance of the tissue to cutting");
  v.group(
      "prestress", c.prestress,
      "initial stress: tissue is under tension at rest and gapes when it is cut; the share of the stress that is in "
      "equilibrium in the given shape is kept. Needs structure lattice with law neo_hookean, or structure surface");
  v.group("tear", c.tear, "resistance of the tissue to tearing");
  v.group("bleeding", c.bleeding, "blood or bile that leaves the tissue where it is cut, as from a vessel");
}

template <class V>
void visitFields(V& v, PartConfig& c) {
  v.text("part", c.part, "name of a part of the mesh or phantom, or of a label");
  v.tissue("tissue", c,
           "preset of tissue properties: gives those of the three keys below that this part does not give");
  v.number("young_modulus_pa", c.young_modulus_pa, {1, 1e9}, "Pa", "Young's modulus E of this part");
  v.number("poisson_ratio", c.poisson_ratio, {0, 0.49}, "1", "Poisson's ratio nu of this part");
  v.number("density_kg_per_m3", c.density_kg_per_m3, {1, 1e5}, "kg/m3", "mass density of this part");
  v.group("cut", c.cut, "resistance of this part to cutting");
  v.group("prestress", c.prestress, "initial stress of this part");
  v.group("bleeding", c.bleeding, "bleeding of this part where it is cut");
  v.vectorOrNone(
      "color", c.color, {0, 1}, "1",
      "colour of this part and, darker, of its inside: red, green, blue; textures of a file cover it. Without "
      "it: that of the mesh file or of the scan, else that of the body");
}

template <class V>
void visitFields(V& v, ImportLimits& c) {
  v.number("max_file_mb", c.max_file_mb, {0.001, 1e6}, "MB",
           "largest size of the file, and of the buffers that it refers to");
  v.integer("max_depth", c.max_depth, {1, 4000}, "glTF: largest depth of nested nodes");
  v.integer("max_instances", c.max_instances, {1, 1e7},
            "glTF: largest number of nodes; a node with several parents counts once for each");
  v.integer("max_triangles", c.max_triangles, {1, 1e9}, "largest number of triangles, counted for each instance");
  v.boolean("other_formats", c.other_formats,
            "permission to try formats that are not listed under `mesh_file`; their importers limit neither depth nor "
            "instances, so use it only for trusted files");
}

template <class V>
void visitFields(V& v, ScanConfig& c) {
  v.text(
      "file", c.file,
      "label map: NIfTI, NRRD or MetaImage file, or DICOM file or folder (docs/scans.md); relative to the scene file");
  v.texts(
      "labels", c.labels, kMostLabels,
      "numbers or names of the labels that make up the body; phantom gallbladder: its parts, where the liver with its "
      "capsule, the fat with its peritoneum, and all others can be bodies of their own; empty: all");
  v.text("names_file", c.names_file,
         "table of label names, of ITK-SNAP or YAML, relative to the scene file; empty: one next to the scan, if any");
  v.text("axes", c.axes, "directions of the axes i, j, k, as in LPS; only for a file that does not state them");
  v.text("transform", c.transform, "transform to use, sform or qform, for a NIfTI file with two that differ");
  v.integer("volume", c.volume, {-1, 1e6}, "index of the volume in a file with several, from 0; -1: the file has one");
  v.text("series", c.series, "number or UID of a DICOM series");
}

template <class V>
void visitFields(V& v, LayerConfig& c) {
  v.number("depth_m", c.depth_m, kLength, "m", "depth below the surface to which the layer reaches");
  v.vector("color", c.color, {0, 1}, "1", "colour of the layer: red, green, blue");
  v.number("toughness_j_per_m2", c.toughness_j_per_m2, kToughness, "J/m2",
           "fracture toughness of the layer, such as a capsule or skin, as material.cut.toughness_j_per_m2; 0: that of "
           "the material or part. Not with structure surface");
}

constexpr double kMostTubeBranches = 32, kMostTubePoints = 200;
constexpr Range kTubeRadius{1e-4, 1};        // m
constexpr Range kOwnTubeRadius{0, 1};        // m
constexpr Range kCavityPressure{0, 200000};  // Pa

template <class V>
void visitFields(V& v, TubeBranch& c) {
  v.text("name", c.name, "name of the branch, a part of the body");
  v.list("path", c.path, kMostTubePoints,
         "points of the axis of the branch, at least two; the first lies in the lumen of the tube or of an earlier "
         "branch");
  v.number("radius_m", c.radius_m, kOwnTubeRadius, "m", "outer radius of the branch; 0: that of the tube");
  v.number("wall_m", c.wall_m, kOwnTubeRadius, "m", "thickness of its wall; 0: that of the tube");
}

template <class V>
void visitFields(V& v, TubeConfig& c) {
  v.list("path", c.path, kMostTubePoints,
         "points of the axis, at least two, in the body's own coordinates; a smooth curve goes through them, which may "
         "not bend tighter than the radius. The tube is open at both ends");
  v.number("radius_m", c.radius_m, kTubeRadius, "m", "outer radius");
  v.number("wall_m", c.wall_m, kTubeRadius, "m",
           "thickness of the wall, at least half a cell; the lumen must be two cells wide");
  v.list("branches", c.branches, kMostTubeBranches, "hollow branches, with lumens that join that of the tube");
}

template <class V>
void visitFields(V& v, PressureConfig& c) {
  v.number("mean_pa", c.mean_pa, kCavityPressure, "Pa",
           "mean pressure in the cavities of the body over that outside, reached after 0.2 s; 0: none. Above 0: needs "
           "structure lattice, solver.integrator leapfrog, solver.backend cpu or auto, solver.start rest");
  v.number("pulse_pa", c.pulse_pa, kCavityPressure, "Pa", "amplitude of the pulse, added as a sine; at most mean_pa");
  v.number("pulse_hz", c.pulse_hz, {0, 20}, "Hz", "frequency of the pulse");
}

template <class V>
void visitFields(V& v, BodyConfig& c) {
  v.text("name", c.name, "name of the body, unique");
  v.choice(
      "source", c.source,
      {{"phantom", TissueSource::kPhantom},
       {"mesh", TissueSource::kMesh},
       {"box", TissueSource::kBox},
       {"sheet", TissueSource::kSheet},
       {"ball", TissueSource::kBall},
       {"tube", TissueSource::kTube},
       {"labels", TissueSource::kLabels}},
      "source of the tissue: a built-in anatomy (`phantom`), a mesh file, a box, a flat sheet, a ball, a hollow tube, "
      "or labels of a scan");
  v.choice("structure", c.structure,
           {{"lattice", Structure::kLattice}, {"explicit", Structure::kExplicit}, {"surface", Structure::kSurface}},
           "structure of the model: a solid lattice; the same lattice with explicit connections (VR05 2.5.1); or "
           "springs along the edges of the surface (cloth, membranes, vessel walls)");
  v.text("mesh_file", c.mesh_file,
         "mesh: path of an OBJ, STL, PLY, glTF or GLB file, or of a Gmsh .msh file of volumes, with its physical "
         "groups as parts; relative to the scene file");
  v.group("scan", c.scan,
          "labels: the scan and which of its labels; each label is a part of the body, under its own name. phantom: "
          "`labels` alone");
  v.number("unit_scale_m", c.unit_scale_m, {1e-9, 1e3}, "m", "mesh: metres per unit of the file");
  v.group("import_limits", c.import_limits,
          "mesh: limits on the contents of the file; a file beyond them is refused before it is read");
  v.choice("up_axis", c.up_axis, {{"z", UpAxis::kZ}, {"y", UpAxis::kY}},
           "mesh: axis of the file that points up and is rotated to z; y in glTF");
  v.boolean("centered", c.centered, "mesh, labels: move the centre of the bounding box to the body's origin");
  v.choice("fill", c.fill, {{"parts", Fill::kParts}, {"enclosed", Fill::kEnclosed}},
           "mesh: region that becomes tissue: the inside of each part, or the region that all parts together enclose, "
           "even if they are patches with gaps, inside out or inside each other (docs/volumes.md)");
  v.number("gap_m", c.gap_m, {1e-6, 1}, "m",
           "fill enclosed: width of the widest gap or hole that is closed; wider openings stay open");
  v.boolean("textures", c.textures,
            "mesh: use the colours, textures, normal maps and roughness of the file (docs/surface.md); labels: use the "
            "colours of the scan's labels (docs/scans.md); phantom gallbladder: use its colours");
  v.text(
      "detail_mesh", c.detail_mesh,
      "path of a finer mesh of the same surface, with any number of faces, placed as mesh_file is; its normals and "
      "colours are baked onto the surface mesh once and kept in the user's cache. Needs structure lattice or explicit");
  v.integer(
      "skin_faces", c.skin_faces, {0, 20e6},
      "number of faces of the surface mesh, approximately; above 0 the surface is simplified to it and the original is "
      "baked onto it as by detail_mesh, while the lattice is built from the original; 0: not simplified");
  v.integer("detail_px", c.detail_px, {64, 16384},
            "largest side of the square texture to which detail is baked; it is exceeded where the surface mesh has "
            "too many faces");
  v.choice("phantom", c.phantom, {{"heart", Anatomy::kHeart}, {"gallbladder", Anatomy::kGallbladder}},
           "phantom: anatomy: a heart, or a gallbladder on the liver with its ducts and vessels "
           "(docs/user_guide.md#built-in-anatomies)");
  v.integer("phantom_seed", c.phantom_seed, {0, 1e6},
            "phantom gallbladder: variant: 0 the usual one, 1 short cystic duct, 2 artery in front of the common duct, "
            "3 two cystic arteries, 4 inflamed; above: features and sizes drawn by this seed");
  v.number("phantom_length_m", c.phantom_length_m, {0.01, 1}, "m",
           "phantom: length from base to apex, or of the gallbladder (0.08 is natural); all sizes follow it");
  v.number("phantom_wall_scale", c.phantom_wall_scale, {0.1, 2}, "1",
           "phantom: factor on every wall thickness; of the gallbladder and the common duct only");
  v.vector("box_size_m", c.box_size_m, {1e-4, 10}, "m",
           "box: edge lengths, centred on the body's origin; sheet: lengths along x and y");
  v.number("ball_radius_m", c.ball_radius_m, {1e-4, 10}, "m", "ball: radius, centred on the body's origin");
  v.group("tube", c.tube, "tube: a hollow, round vessel along a path, with branches; its own part is `tube`");
  v.group("pressure", c.pressure,
          "pressure in the lumen of a tube, or in the cavities that tissue encloses (docs/physics.md#18-pressure)");
  v.number("thickness_m", c.thickness_m, {1e-6, 1}, "m",
           "structure surface: thickness of the membrane, which gives mass and stiffness");
  v.number("bending_ratio", c.bending_ratio, {0, 1}, "1",
           "stiffness of bending springs over that of the springs around them: across the edges of a surface, or along "
           "one-node-thick parts of an explicit lattice; 0: no bending springs. They shorten the stable substep");
  v.vector("force_n", c.force_n, {-1e3, 1e3}, "N", "constant force on the body, distributed over its nodes by mass");
  v.numberOrAuto("spacing_m", c.spacing_m, c.auto_spacing, {1e-5, 10}, "m",
                 "lattice spacing h, or edge length of a surface (the longest of a mesh); auto: the finest lattice "
                 "that this machine steps in real time (solver.real_time_factor)");
  v.integer("target_nodes", c.target_nodes, {0, 20e6},
            "target number of nodes, reached within 2 %, or on surfaces as closely as whole triangles allow; above 0 "
            "it replaces spacing_m");
  v.choice(
      "skin", c.skin, {{"auto", SkinSource::kAuto}, {"input", SkinSource::kInput}, {"volume", SkinSource::kVolume}},
      "source of the surface mesh: the input mesh, or extracted from the volume; auto: the input mesh if there is one");
  v.choice("mapping", c.mapping,
           {{"auto", Mapping::kAuto},
            {"one_to_one", Mapping::kOneToOne},
            {"constant", Mapping::kConstant},
            {"interpolated", Mapping::kInterpolated},
            {"along_normal", Mapping::kAlongNormal}},
           "mapping of the surface mesh to the lattice (docs/surface.md): each vertex follows one node (EGVE 3.2), a "
           "triangle of nodes (eqs 4 to 7), the same turned by approximate normals (eq 8), or these normals alone "
           "(3.5); auto: the corners of the cell where cells are partly tissue, else interpolated");
  v.number("skin_spacing_m", c.skin_spacing_m, kLength, "m",
           "phantom, ball, tube: edge length of the surface mesh, if it is to be finer than the lattice; 0: that of "
           "the lattice");
  v.vector("position_m", c.position_m, kCoordinate, "m", "position of the body's origin in the tissue frame");
  v.vector("rotation_deg", c.rotation_deg, kAngle, "deg",
           "rotation of the body: turns about the fixed x, then y, then z axis");
  v.vector("color", c.color, {0, 1}, "1", "colour where a mesh file or scan gives none: red, green, blue");
  v.number("roughness", c.roughness, {0, 1}, "1", "roughness of the wet surface: 0 mirrors lamps, 1 is dull");
  v.number("color_variation", c.color_variation, {0, 3}, "1",
           "variation of lightness, hue and relief over the surface; 0: uniform");
  v.number("specular_wetness", c.specular_wetness, {0, 1}, "1",
           "share of the surface under a film of fluid, which is uneven and moves with the tissue "
           "(docs/surface.md#looks); 0: no film, only `roughness`");
  v.number(
      "cut_wall_texture", c.cut_wall_texture, {0, 2}, "1",
      "strength of the texture on walls of wounds: lobules of fat, and bundles of muscle below the `layers`; 0: none");
  v.number("blanching", c.blanching, {0, 1}, "1",
           "paleness of skin under pressure, reached in full where springs are shortened by 0.03 on average (not over "
           "textures of a file, which keep their colours); 0: it keeps its colour");
  v.list("layers", c.layers, kMostLayers,
         "layers below the surface, from the outside inwards: the colours that walls of wounds show and the toughness; "
         "below the last one: the inside of the body or part, of its `color`; []: that alone");
  v.group("material", c.material, "elastic material");
  const MaterialConfig& m = c.material;
  const PartConfig as_material{"",    m.young_modulus_pa, m.poisson_ratio, m.density_kg_per_m3, "",
                               m.cut, m.prestress,        m.bleeding};
  v.list("parts", c.parts, 64,
         "parts with another elasticity, toughness or bleeding; keys that are left out are as in `material`",
         as_material);
  v.list("fixed", c.fixed, 64, "regions that hold their nodes in space");
}

}  // namespace viscera
