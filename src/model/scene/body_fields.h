// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "model/scene/field_ranges.h"
#include "viscera/model/scene/body_config.h"

namespace viscera {

// Scene keys of bodies (scene_fields.h).

constexpr int kMostLayers = 4;
constexpr int kMostLabels = 255;
constexpr Range kToughness{0, 1e6};  // J/m2

template <class V>
void visitFields(V& v, FixedConfig& c) {
  v.choice("shape", c.shape,
           {{"box", FixedShape::kBox},
            {"sphere", FixedShape::kSphere},
            {"plane", FixedShape::kPlane},
            {"part", FixedShape::kPart}},
           "which nodes are held in space; coordinates are the body's own, before its pose. With material.law: "
           "neo_hookean nodes within half a cell of the region are held too, on its border only those of faces that "
           "tissue reaches, and nodes lie on a plane that is parallel to the lattice (docs/fill_rule.md)");
  v.vector("min_m", c.min_m, kCoordinate, "m", "box: lower corner");
  v.vector("max_m", c.max_m, kCoordinate, "m", "box: upper corner");
  v.vector("center_m", c.center_m, kCoordinate, "m", "sphere: centre");
  v.number("radius_m", c.radius_m, kLength, "m", "sphere: radius");
  v.vector("point_m", c.point_m, kCoordinate, "m", "plane: a point of it");
  v.vector("normal", c.normal, kDirection, "", "plane: nodes on the side it points away from are held");
  v.text("part", c.part, "part: name of a part of the mesh or phantom, or of a label");
}

template <class V>
void visitFields(V& v, FractureConfig& c) {
  v.numberOrAuto(
      "toughness_j_per_m2", c.toughness_j_per_m2, c.of_tissue, kToughness, "J/m2",
      "work that a blade does per area that it parts, felt by the hand (docs/cutting.md); 0: it parts what it "
      "crosses and is not felt; auto: that of the tissue (docs/tissues.md#toughness). Above 0: solver.integrator "
      "leapfrog");
}

template <class V>
void visitFields(V& v, PrestressConfig& c) {
  constexpr Range kPrestrain{-0.3, 0.5};
  v.number("strain", c.strain, kPrestrain, "1",
           "how much shorter, of its length, tissue would be along any axis if nothing held it; of structure surface "
           "along its surface (docs/cutting.md 6)");
  v.vector("strains", c.strains, kPrestrain, "1", "the same along three axes, besides `strain`");
  v.vector("axes_deg", c.axes_deg, kAngle, "deg",
           "turns the axes of `strains`, which are the tissue frame's, about the fixed x, then y, then z axis");
}

template <class V>
void visitFields(V& v, TearConfig& c) {
  v.number(
      "toughness_j_per_m2", c.toughness_j_per_m2, {0, 1e6}, "J/m2",
      "work per area that it takes to pull the tissue apart (docs/cutting.md 8); 0: it stretches without end. Above "
      "0: structure lattice, solver.integrator leapfrog, solver.backend cpu or auto");
}

template <class V>
void visitFields(V& v, BleedingConfig& c) {
  v.number("flow_ml_per_min", c.flow_ml_per_min, {0, 1e4}, "ml/min",
           "out of a stump that is cut clean through, of a smaller wound by its share of the cross section "
           "(docs/lessons/bleeding.md); 0: it does not bleed, and costs nothing");
  v.number("calibre_m", c.calibre_m, {0, 1}, "m",
           "diameter of a vessel with that flow; 0: by the volume of the part over how far its ends are apart, which a "
           "part that bends or branches has not");
}

template <class V>
void visitFields(V& v, MaterialConfig& c) {
  v.tissue("tissue", c, "gives the three keys below that the scene does not give; not for diagnosis or planning");
  v.number("young_modulus_pa", c.young_modulus_pa, {1, 1e9}, "Pa", "Young's modulus E");
  v.number("poisson_ratio", c.poisson_ratio, {0, 0.49}, "1",
           "Poisson's ratio nu; law springs has 1/4 and no other; structure surface has that of its springs, 1/3");
  v.number("density_kg_per_m3", c.density_kg_per_m3, {1, 1e5}, "kg/m3", "mass density");
  v.number("drag_per_s", c.drag_per_s, {0, 1e4}, "1/s", "node drag gamma: every velocity decays at this rate");
  v.number("dashpot_ratio", c.dashpot_ratio, {0, 0.5}, "1",
           "axial dashpot: damping ratio at the highest frequency; 0 leaves it out of the kernel");
  v.choice("weights", c.weights, {{"cell", Weights::kCell}, {"paper", Weights::kPaper}},
           "assembly of springs and masses: per solid cell (exact), or VR05's uniform weights");
  v.choice(
      "law", c.law, {{"auto", Law::kAuto}, {"neo_hookean", Law::kNeoHookean}, {"springs", Law::kSprings}},
      "what the cells are made of: a neo-Hookean energy each, accurate at large strain, cells at the surface filled in "
      "part (structure lattice, solver.integrator leapfrog), or springs as in the papers, cells full or empty; auto is "
      "neo_hookean in structure lattice where leapfrog steps and weights is cell, else springs");
  v.choice("walls", c.walls, {{"cells", Walls::kCells}, {"rows", Walls::kRows}},
           "law neo_hookean: how walls below three cells that are askew to the lattice bend: by what their cells' own "
           "corners show, or by rows of nodes, with a third to a half of the error, at three to six times the time for "
           "such cells (docs/physics.md#thin-walls, docs/material.md#beside-finite-elements)");
  v.numberOrAuto(
      "stiffening", c.stiffening, c.stiffens_as_tissue, {0, 100}, "1",
      "law neo_hookean: b of its shear energy mu/(2 b) (exp(b (I1 - 3)) - 1), so that tissue stiffens as it is "
      "stretched, by exp(b (I1 - 3)) and 20 times at most; 0: none, and costs nothing; auto: that of the tissue "
      "(docs/tissues.md#stiffening)");
  v.group("cut", c.cut, "what it takes to part the tissue");
  v.group(
      "prestress", c.prestress,
      "tissue pulls before anything touches it, and gapes when cut; what balances in the given shape is kept. Needs "
      "structure lattice, with law neo_hookean, or surface");
  v.group("tear", c.tear, "what it takes to pull it apart");
  v.group("bleeding", c.bleeding, "blood that runs out where it is cut, as if it were a vessel");
}

template <class V>
void visitFields(V& v, PartConfig& c) {
  v.text("part", c.part, "name of a part of the mesh or phantom, or of a label");
  v.tissue("tissue", c, "gives the three keys below that this part does not give");
  v.number("young_modulus_pa", c.young_modulus_pa, {1, 1e9}, "Pa", "Young's modulus E of this part");
  v.number("poisson_ratio", c.poisson_ratio, {0, 0.49}, "1", "Poisson's ratio nu of this part");
  v.number("density_kg_per_m3", c.density_kg_per_m3, {1, 1e5}, "kg/m3", "mass density of this part");
  v.group("cut", c.cut, "what it takes to part it");
  v.group("prestress", c.prestress, "prestress of this part");
  v.group("bleeding", c.bleeding, "blood that runs out where this part is cut");
}

template <class V>
void visitFields(V& v, ImportLimits& c) {
  v.number("max_file_mb", c.max_file_mb, {0.001, 1e6}, "MB", "size of the file, and of buffers that it refers to");
  v.integer("max_depth", c.max_depth, {1, 4000}, "glTF: nodes within nodes");
  v.integer("max_instances", c.max_instances, {1, 1e7}, "glTF: nodes, those with several parents once for each");
  v.integer("max_triangles", c.max_triangles, {1, 1e9}, "triangles, counted for each instance");
  v.boolean("other_formats", c.other_formats,
            "try formats that are not listed under `mesh_file` too, whose importers have limits of neither depth nor "
            "instances: for files that you trust");
}

template <class V>
void visitFields(V& v, ScanConfig& c) {
  v.text(
      "file", c.file,
      "label map: NIfTI, NRRD or MetaImage file, or DICOM file or folder (docs/scans.md); relative to the scene file");
  v.texts("labels", c.labels, kMostLabels, "numbers or names of the labels that the body is made of; none: all");
  v.text("names_file", c.names_file,
         "table of names, of ITK-SNAP or YAML, relative to the scene file; empty: one that lies beside the scan");
  v.text("axes", c.axes, "where i, j, k lead to, as in LPS, where the file does not say");
  v.text("transform", c.transform, "sform or qform, where a NIfTI file has two that differ");
  v.integer("volume", c.volume, {-1, 1e6}, "which volume of a file with several, from 0; -1: it has one");
  v.text("series", c.series, "number or UID of a DICOM series");
}

template <class V>
void visitFields(V& v, LayerConfig& c) {
  v.number("depth_m", c.depth_m, kLength, "m", "below the skin, to which it reaches");
  v.vector("color", c.color, {0, 1}, "1", "red, green, blue");
  v.number(
      "toughness_j_per_m2", c.toughness_j_per_m2, kToughness, "J/m2",
      "of a capsule or skin, as material.cut.toughness_j_per_m2; 0: that of the material or part. Not in structure "
      "surface");
}

template <class V>
void visitFields(V& v, BodyConfig& c) {
  v.text("name", c.name, "name, unique");
  v.choice(
      "source", c.source,
      {{"phantom", TissueSource::kPhantom},
       {"mesh", TissueSource::kMesh},
       {"box", TissueSource::kBox},
       {"sheet", TissueSource::kSheet},
       {"ball", TissueSource::kBall},
       {"labels", TissueSource::kLabels}},
      "where the tissue comes from: the built-in heart, a mesh file, a box, a flat sheet, a ball, labels of a scan");
  v.choice("structure", c.structure,
           {{"lattice", Structure::kLattice}, {"explicit", Structure::kExplicit}, {"surface", Structure::kSurface}},
           "what is made of it: a solid lattice; the same with explicit connections (VR05 2.5.1); springs along the "
           "edges of its surface (cloth, membranes, vessel walls)");
  v.text("mesh_file", c.mesh_file,
         "mesh: OBJ, STL, PLY, glTF or GLB file, or a Gmsh .msh file of volumes, whose physical groups are parts; "
         "relative "
         "to the scene file");
  v.group("scan", c.scan, "labels: the scan and which of its labels; each label is a part of the body, by its name");
  v.number("unit_scale_m", c.unit_scale_m, {1e-9, 1e3}, "m", "mesh: metres per unit of the file");
  v.group("import_limits", c.import_limits,
          "mesh: what the file may hold; what holds more is refused before it is read");
  v.choice("up_axis", c.up_axis, {{"z", UpAxis::kZ}, {"y", UpAxis::kY}},
           "mesh: axis of the file that points up and is turned to z; y in glTF");
  v.boolean("centered", c.centered, "mesh, labels: move the middle of its bounding box to the body's origin");
  v.choice(
      "fill", c.fill, {{"parts", Fill::kParts}, {"enclosed", Fill::kEnclosed}},
      "mesh: what is tissue: the inside of each part, or what all parts enclose together, patches with gaps, turned "
      "inside out or lying in each other as they are (docs/fill_rule.md)");
  v.number("gap_m", c.gap_m, {1e-6, 1}, "m",
           "fill enclosed: widest gap or hole that is closed; openings that are wider stay open");
  v.boolean("textures", c.textures,
            "mesh: take the colours, textures, normal maps and roughness that the file gives (docs/detail.md)");
  v.text(
      "detail_mesh", c.detail_mesh,
      "a finer mesh of the same surface, of any number of faces, placed as mesh_file is: its normals and colours are "
      "baked onto the skin once, and kept in the user's cache; structure lattice and explicit");
  v.integer("skin_faces", c.skin_faces, {0, 20e6},
            "above 0: the surface is simplified to about so many faces, and what it was is baked onto them as by "
            "detail_mesh; the lattice is made of all of it");
  v.integer("detail_px", c.detail_px, {64, 16384},
            "side of the square of texels that detail is baked to, at most; more is taken where the skin has too many "
            "faces");
  v.number("phantom_length_m", c.phantom_length_m, {0.01, 1}, "m", "phantom: base to apex");
  v.number("phantom_wall_scale", c.phantom_wall_scale, {0.1, 2}, "1", "phantom: multiplies every wall thickness");
  v.vector("box_size_m", c.box_size_m, {1e-4, 10}, "m",
           "box: edge lengths, centred on the body's origin; sheet: x and y");
  v.number("ball_radius_m", c.ball_radius_m, {1e-4, 10}, "m", "ball: radius, centred on the body's origin");
  v.number("thickness_m", c.thickness_m, {1e-6, 1}, "m", "structure surface: of the membrane, for mass and stiffness");
  v.number("bending_ratio", c.bending_ratio, {0, 1}, "1",
           "stiffness of springs against bending over that of the springs around: across the edges of a surface, along "
           "one-node-thick parts of an explicit lattice; 0: none. They shorten the stable substep");
  v.vector("force_n", c.force_n, {-1e3, 1e3}, "N", "constant force on the body, spread over its nodes by mass");
  v.numberOrAuto(
      "spacing_m", c.spacing_m, c.auto_spacing, {1e-5, 10}, "m",
      "lattice spacing h, edge length of a surface (the longest of a mesh); auto: the finest lattice that this "
      "machine steps in real time (solver.real_time_factor)");
  v.integer(
      "target_nodes", c.target_nodes, {0, 20e6},
      "node count to reach within 2 %, of surfaces as near as whole triangles come; above 0 it decides instead of "
      "spacing_m");
  v.choice("skin", c.skin,
           {{"auto", SkinSource::kAuto}, {"input", SkinSource::kInput}, {"volume", SkinSource::kVolume}},
           "detailed surface: the input mesh, or extracted from the volume; auto takes the mesh where there is one");
  v.choice("mapping", c.mapping,
           {{"auto", Mapping::kAuto},
            {"one_to_one", Mapping::kOneToOne},
            {"constant", Mapping::kConstant},
            {"interpolated", Mapping::kInterpolated},
            {"along_normal", Mapping::kAlongNormal}},
           "how the skin follows the lattice (docs/mappings.md): each vertex one node (EGVE 3.2), a triangle of nodes "
           "(eqs 4 to 7), that turned by approximate normals (eq 8), or moved along these alone (3.5); auto: the "
           "corners of the cell where cells are tissue in part, else interpolated");
  v.number("skin_spacing_m", c.skin_spacing_m, kLength, "m",
           "phantom, ball: edge length of the skin where it is to be finer than the lattice; 0: the lattice's");
  v.vector("position_m", c.position_m, kCoordinate, "m", "origin of the body in the tissue frame");
  v.vector("rotation_deg", c.rotation_deg, kAngle, "deg", "turns about the fixed x, then y, then z axis");
  v.vector("color", c.color, {0, 1}, "1", "red, green, blue; of what a mesh file gives no colour");
  v.number("roughness", c.roughness, {0, 1}, "1", "of the wet surface: 0 mirrors lamps, 1 is dull");
  v.number("mottling", c.mottling, {0, 3}, "1", "how much lightness, hue and relief vary from place to place; 0: even");
  v.number("wetness", c.wetness, {0, 1}, "1",
           "share of the surface under a film of fluid, which lies unevenly and stays where it is on the tissue "
           "(docs/detail.md#looks); 0: none but what `roughness` says");
  v.number("wall_grain", c.wall_grain, {0, 2}, "1",
           "how much lobules of fat, and bundles of muscle below the `layers`, show on walls of wounds; 0: not at all");
  v.number("blanching", c.blanching, {0, 1}, "1",
           "how pale skin becomes where it is pressed; all of it where springs are shortened by 0.03 in the mean (not "
           "over textures of a file, which are as painted); 0: it keeps its colour");
  v.list("layers", c.layers, kMostLayers,
         "what a wound's wall shows below the skin, from the surface down, and what it takes to part it; beyond the "
         "last one: the flesh of `color`");
  v.group("material", c.material, "elastic material");
  const MaterialConfig& m = c.material;
  const PartConfig as_material{"",    m.young_modulus_pa, m.poisson_ratio, m.density_kg_per_m3, "",
                               m.cut, m.prestress,        m.bleeding};
  v.list("parts", c.parts, 64,
         "parts whose elasticity, toughness or bleeding differs; what is left out is as in `material`", as_material);
  v.list("fixed", c.fixed, 64, "regions whose nodes are held in space");
}

}  // namespace viscera
