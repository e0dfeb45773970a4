// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ticks/process_list.h"

#include <algorithm>

namespace viscera {

ProcessList::ProcessList(TissueProcesses processes, size_t good_states)
    : processes_(std::move(processes)), kept_(processes_.size()), good_states_(good_states) {}

bool ProcessList::readCuts() const {
  return std::any_of(processes_.begin(), processes_.end(), [](const auto& process) { return process->readsCuts(); });
}

void ProcessList::cutsChanged(const CutSprings& cuts) {
  for (const auto& process : processes_) {
    if (process->readsCuts()) process->cutsChanged(cuts);
  }
}

void ProcessList::beginTick(const ProcessTick& tick) {
  for (const auto& process : processes_) process->beginTick(tick);
}

uint64_t ProcessList::act(TissuePort& port, const ProcessTick& tick, const ProcessSubstep& substep) {
  uint64_t cut = 0;
  for (const auto& process : processes_) cut += process->act(port, tick, substep);
  return cut;
}

uint64_t ProcessList::endTick(TissuePort& port, const ProcessTick& tick) {
  uint64_t cut = 0;
  for (const auto& process : processes_) cut += process->endTick(port, tick, processes_);
  return cut;
}

bool ProcessList::pushStyluses(const ProcessTick& tick) const {
  return std::any_of(processes_.begin(), processes_.end(),
                     [&](const auto& process) { return process->pushesStyluses(tick); });
}

StylusPulls ProcessList::pulls() const {
  StylusPulls out;
  for (const auto& process : processes_) process->addPulls(out);
  return out;
}

double ProcessList::work_j() const {
  double out = 0;
  for (const auto& process : processes_) out += std::max(0.0, process->work_j());
  return out;
}

void ProcessList::reset() {
  for (const auto& process : processes_) process->reset();
}

void ProcessList::saveGood() {
  for (size_t i = 0; i < processes_.size(); ++i) {
    if (processes_[i]->rollBack() != RollBack::kUndo) continue;
    Archive archive;
    archive.section({});
    processes_[i]->persistUndone(archive);
    States& states = kept_[i];
    if (states.size() == good_states_) states.erase(states.begin());
    states.push_back(archive.take());
  }
}

void ProcessList::restoreGood(int back) {
  const auto wanted = static_cast<size_t>(back);
  for (size_t i = 0; i < processes_.size(); ++i) {
    States& states = kept_[i];
    if (processes_[i]->rollBack() != RollBack::kUndo || states.empty()) continue;
    const size_t most = states.size() - 1;
    states.resize(states.size() - std::min(wanted, most));
    Archive archive(states.back());
    archive.section({});
    processes_[i]->persistUndone(archive);
    processes_[i]->undone(wanted > most);
  }
}

void ProcessList::clearGood() {
  for (States& states : kept_) states.clear();
}

uint64_t ProcessList::restart(TissuePort& port) {
  uint64_t cut = 0;
  for (const auto& process : processes_) {
    if (process->rollBack() == RollBack::kRestart) cut += process->restart(port);
  }
  return cut;
}

void ProcessList::persist(Archive& archive) {
  for (size_t i = 0; i < processes_.size(); ++i) {
    processes_[i]->persist(archive);
    if (processes_[i]->rollBack() != RollBack::kUndo) continue;
    States& states = kept_[i];
    uint64_t count = states.size();
    archive.value(count);
    archive.require(count <= good_states_, "states to roll back to: " + std::to_string(count) + "; 0 .. " +
                                               std::to_string(good_states_) + " are accepted");
    states.resize(count);
    for (std::vector<Archive::Section>& state : states) {
      if (archive.reads()) state.assign(1, {});
      archive.list(state[0].bytes);
    }
  }
}

}  // namespace viscera
