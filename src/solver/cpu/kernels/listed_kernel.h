// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/cpu/kernels/contact_lists.h"

namespace viscera::glsl {

/// A kernel with contacts that were found before.
struct ListedKernel : CollisionKernel {
  using CollisionKernel::CollisionKernel;
  const ContactLists* lists = nullptr;
};

// VARIANT_MEMBERS of such a kernel, in place of the shader's search.
#define VISIT_LISTED                                                          \
  void visitListed(uint e) {                                                  \
    const Entry me = entryAt(e);                                              \
    begin();                                                                  \
    for (const ListedContact* c = lists->begin(e); c != lists->end(e); ++c) { \
      visit(me, entryAt(c->other), c->distance_m);                            \
    }                                                                         \
    end(me.slot);                                                             \
  }

/// Applies contacts to the entries of a job.
template <class Kernel>
__attribute__((flatten)) void visitListed(Kernel kernel, const ContactLists& lists, size_t job) {
  kernel.lists = &lists;
  const auto range = lists.entriesOf(job);
  for (size_t e = range[0]; e < range[1]; ++e) kernel.visitListed(static_cast<uint32_t>(e));
}

}  // namespace viscera::glsl
