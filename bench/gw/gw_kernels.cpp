// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/gw/gw_kernels.h"

#include <GL/glew.h>

#include <algorithm>
#include <numeric>
#include <string>

#include "bench/gw/gw_units.h"
#include "layout/bindings.h"

namespace viscera::bench {

namespace {

gpu::Program compile(const std::string& name, std::vector<std::string> defines = {}) {
  defines.push_back("GROUP_SIZE " + std::to_string(layout::kGroupSize));
  defines.emplace_back("NETWORK");
  return gpu::Program::compute(name, defines);
}

void run(const gpu::Program& program, size_t invocations) {
  program.use();
  program.set("count", static_cast<uint32_t>(invocations));
  gpu::Program::dispatch(invocations, layout::kGroupSize);
  gpu::Program::storageBarrier();
}

/// Returns [slots] 1/kg; 0 for fixed nodes and slots without a node.
std::vector<float> inverseMasses(const GwNetwork& network) {
  std::vector<float> out(network.slots(), 0);
  for (uint32_t slot : network.body().lattice.active_slots) {
    if (isFixed(network.body().lattice.nodes[slot])) continue;
    out[slot] = static_cast<float>(1 / network.network().masses_kg[slot]);
  }
  return out;
}

/// Writes four numbers per node, the layout of texels.
template <class Number>
void write(gpu::RawBuffer& buffer, const Field& vectors) {
  std::vector<Number> values;
  for (const Vector3d& v : vectors) {
    for (double component : {v.x(), v.y(), v.z(), 0.0}) values.push_back(Number(static_cast<float>(component)));
  }
  buffer.write(0, values.size() * sizeof(Number), values.data());
}

template <class Number>
Field readVectors(const gpu::RawBuffer& buffer, size_t slots) {
  std::vector<Number> values(4 * slots);
  buffer.read(0, values.size() * sizeof(Number), values.data());
  Field out;
  for (size_t i = 0; i < slots; ++i) {
    const auto at = [&](size_t axis) { return static_cast<double>(static_cast<float>(values[4 * i + axis])); };
    out.emplace_back(at(0), at(1), at(2));
  }
  return out;
}

template <class T>
size_t bytesOf(const gpu::Buffer<T>& buffer) {
  return buffer.raw().bytes();
}

}  // namespace

GwKernels::GwKernels(const GwNetwork& network, StateFormat format)
    : network_(network),
      format_(format),
      point_(compile("gw_point.comp")),
      point_pass_(compile("gw_point.comp", {"ONE_NEIGHBOUR"})),
      edge_runs_(compile("gw_edge.comp", {"PER_LINK"})),
      edge_each_(compile("gw_edge.comp")),
      sum_(compile("gw_sum.comp")),
      inverse_mass_(inverseMasses(network)),
      forces_(network.slots()),
      link_forces_(2 * network.springs()),
      spring_forces_(network.springs()) {
  std::vector<std::string> half;
  if (format == StateFormat::kFloat16) half.emplace_back("HALF");
  integrate_ = compile("gw_integrate.comp", half);
  half.emplace_back("TARGET");
  integrate_target_ = compile("gw_integrate.comp", half);

  const NetworkLinks links = linksOf(network.network());
  links_ = gpu::Buffer<layout::Link>(links.links);
  starts_ = gpu::Buffer<uint32_t>(links.starts);
  springs_ = gpu::Buffer<layout::SpringEnds>(links.ends);
  makeViews();
  makeOrder();
  for (State& state : states_) state = makeState();
}

void GwKernels::makeViews() {
  links_view_ = TexelArray(links_.id(), GL_RGBA32UI);
  starts_view_ = TexelArray(starts_.id(), GL_R32UI);
  springs_view_ = TexelArray(springs_.id(), GL_RGBA32UI);
  mass_view_ = TexelArray(inverse_mass_.id(), GL_R32F);
  forces_view_ = TexelArray(forces_.id(), GL_RGBA32F);
  link_forces_view_ = TexelArray(link_forces_.id(), GL_RGBA32F);
  spring_forces_view_ = TexelArray(spring_forces_.id(), GL_RGBA32F);
}

GwKernels::State GwKernels::makeState() const {
  State state;
  const size_t bytes = network_.slots() * vectorBytes();
  const GLenum format = format_ == StateFormat::kFloat16 ? GL_RGBA16F : GL_RGBA32F;
  state.u = gpu::RawBuffer(bytes);
  state.v = gpu::RawBuffer(bytes);
  state.u_view = TexelArray(state.u.id(), format);
  state.v_view = TexelArray(state.v.id(), format);
  return state;
}

/// Sorts nodes by falling valence, as GW do, so that every pass covers a contiguous block.
void GwKernels::makeOrder() {
  const std::vector<uint32_t> starts = starts_.read();
  const auto valence = [&](uint32_t node) { return starts[node + 1] - starts[node]; };
  std::vector<uint32_t> order(network_.slots());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return valence(a) > valence(b); });
  for (uint32_t pass = 0; pass < valence(order[0]); ++pass) {
    const auto above = [&](uint32_t node) { return valence(node) > pass; };
    with_valence_above_.push_back(static_cast<size_t>(std::count_if(order.begin(), order.end(), above)));
  }
  order_ = gpu::Buffer<uint32_t>(order);
}

void GwKernels::bindMesh() const {
  states_[current_].u_view.bind(layout::kUnitDisplacement);
  states_[current_].v_view.bind(layout::kUnitVelocity);
  links_view_.bind(layout::kUnitLinks);
  starts_view_.bind(layout::kUnitLinkStarts);
  springs_view_.bind(layout::kUnitSprings);
}

void GwKernels::pointForces() {
  bindMesh();
  forces_.bindStorage(0);
  run(point_, network_.slots());
}

void GwKernels::pointPasses() {
  bindMesh();
  forces_.bindStorage(0);
  order_.bindStorage(1);
  for (uint32_t pass = 0; pass < with_valence_above_.size(); ++pass) {
    point_pass_.set("neighbour", pass);
    run(point_pass_, with_valence_above_[pass]);
  }
}

void GwKernels::springForces() {
  bindMesh();
  link_forces_.bindStorage(0);
  run(edge_runs_, network_.springs());
}

void GwKernels::sumForces() {
  forces_.bindStorage(0);
  starts_view_.bind(layout::kUnitLinkStarts);
  link_forces_view_.bind(layout::kUnitLinkForces);
  run(sum_, network_.slots());
}

void GwKernels::forceTexture() {
  bindMesh();
  spring_forces_.bindStorage(0);
  run(edge_each_, network_.springs());
}

void GwKernels::scatterForces(BlendTarget& target) {
  springs_view_.bind(layout::kUnitSprings);
  spring_forces_view_.bind(layout::kUnitLinkForces);
  target.add(network_.springs());
}

void GwKernels::integrate(const GwMotion& motion, const BlendTarget* target) {
  const State& next = states_[1 - current_];
  bindMesh();
  mass_view_.bind(layout::kUnitInverseMass);
  if (target) {
    target->bindTexture(layout::kUnitForces);
  } else {
    forces_view_.bind(layout::kUnitForces);
  }
  gpu::bindStorages(0, {next.u.id(), next.v.id()});
  const gpu::Program& program = target ? integrate_target_ : integrate_;
  const auto dt_s = static_cast<float>(motion.dt_s);
  const Eigen::Vector3f gravity = motion.gravity_m_per_s2.cast<float>();
  program.set("dt_s", dt_s);
  program.set("kick_s", first_ ? 0.5F * dt_s : dt_s);
  program.set("mass_damping_per_s", static_cast<float>(network_.body().material.mass_damping_per_s));
  program.set("gravity", {gravity.x(), gravity.y(), gravity.z()});
  if (target) program.set("decoding", {static_cast<float>(target->scale_n()), static_cast<float>(target->zero())});
  run(program, network_.slots());
  current_ = 1 - current_;
  first_ = false;
}

void GwKernels::start(const Field& u_m) {
  State& state = states_[current_];
  state.v.clear();
  first_ = true;
  if (format_ == StateFormat::kFloat16) {
    write<Eigen::half>(state.u, u_m);
  } else {
    write<float>(state.u, u_m);
  }
}

Field GwKernels::forces() const {
  return readVectors<float>(forces_.raw(), network_.slots());
}

Field GwKernels::displacements() const {
  const gpu::RawBuffer& u = states_[current_].u;
  return format_ == StateFormat::kFloat16 ? readVectors<Eigen::half>(u, network_.slots())
                                          : readVectors<float>(u, network_.slots());
}

size_t GwKernels::pointBytes() const {
  return bytesOf(links_) + bytesOf(starts_) + bytesOf(forces_) + states_[0].u.bytes() + bytesOf(inverse_mass_);
}

size_t GwKernels::edgeBytes() const {
  const size_t nodes = bytesOf(forces_) + states_[0].u.bytes() + bytesOf(inverse_mass_);
  return nodes + bytesOf(springs_) + bytesOf(links_) + bytesOf(starts_) + bytesOf(link_forces_);
}

}  // namespace viscera::bench
