// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A cell of two materials with a plane interface of normal N (physics.md 1, Two materials in a cell). Its layers have the
// gradients F + s a N^T, with s the signed share of the other layer. The jump a minimises their energy; then the tractions of
// both are equal. The tractions shear e + kappa m, with e = (F - C) N, m = C N, C = cof F, put a in the plane of e and m: a =
// alpha e + beta m, two unknowns.
// After the stress and the density of law.glsl. Feature: LAMINATES

/// Both layers at their jump.
struct LawLaminate {
  vec3 jump;
  LawLayer a, b;
  float size_a, size_b;  // |F|^2 - 3
};

/// Return the derivatives of kappa and shear of a layer along a change of a, over its s: by_e is m.da, by_f is f.da with f = F N.
float lawKappaAlong(LawLayer y, float bulk, float by_e, float by_f) {
  float of_e = 0.5f * bulk * (1.0f + y.inverse * y.inverse) + y.shear * y.inverse * (1.0f + 5.0f / 3.0f * y.off);
  return of_e * by_e - (2.0f / 3.0f) * y.shear * y.inverse * by_f;
}
float lawShearAlong(LawLayer y, float by_e) { return -2.0f / 3.0f * y.shear * y.slope * by_e; }

/// Returns the share of a Newton step in which a layer loses at most 0.7 of its volume. @param gains  change of volume by the
/// whole step
float lawLaminateStep(LawLayer y, float gains) {
  float most = max(0.7f * (1.0f + y.e), 0.1f);
  return gains < -most ? -most / gains : 1.0f;
}

/// Returns the layers at the jump with equal tractions. @param d, c, e  mean gradient less 1, its cofactors less 1 and its
/// dilation
LawLaminate lawLaminate(CellMoments t, LawColumns d, LawColumns c, float e, float stiffening) {
  vec3 n = t.plane.xyz, m = n + n.x * c.a + n.y * c.b + n.z * c.c;
  vec3 off = n.x * (d.a - c.a) + n.y * (d.b - c.b) + n.z * (d.c - c.c);
  float om = dot(off, m), oo = dot(off, off), mm = max(dot(m, m), 1e-6f), of = oo + om, j = 1.0f + e, size = lawSize(d);
  float sa = 1.0f - t.plane.w, sb = -t.plane.w, ra = t.layers.x, rb = t.layers.y, wa = ra * sa, wb = -rb * sb;
  float alpha = (rb - ra) / (wa + wb), beta = -alpha * om / mm;  // exact but for the layers' volumes
  LawLaminate out_;
  for (int step = 0; step <= kLaminateSteps; ++step) {
    float by_e = alpha * om + beta * mm, by_f = alpha * of + beta * j;
    float square = alpha * alpha * oo + 2.0f * alpha * beta * om + beta * beta * mm;
    out_.size_a = size + 2.0f * sa * by_f + sa * sa * square;
    out_.size_b = size + 2.0f * sb * by_f + sb * sb * square;
    LawLayer a = lawLayer(e + sa * by_e, out_.size_a, t.layers.z, stiffening), b = lawLayer(e + sb * by_e, out_.size_b, t.layers.w, stiffening);
    out_.a = a;
    out_.b = b;
    if (step == kLaminateSteps) break;
    // Difference of the tractions along e and along m, and its derivatives by alpha and beta.
    float along_off = ra * a.shear * (1.0f + sa * alpha) - rb * b.shear * (1.0f + sb * alpha);
    float along_m = ra * (a.shear * sa * beta + a.kappa) - rb * (b.shear * sb * beta + b.kappa);
    float of_a = of + sa * (alpha * oo + beta * om), of_b = of + sb * (alpha * oo + beta * om);
    float oa = wa * (a.shear + lawShearAlong(a, om) * (1.0f + sa * alpha)) + wb * (b.shear + lawShearAlong(b, om) * (1.0f + sb * alpha));
    float ob = wa * lawShearAlong(a, mm) * (1.0f + sa * alpha) + wb * lawShearAlong(b, mm) * (1.0f + sb * alpha);
    float ma = wa * (lawKappaAlong(a, t.layers.z, om, of_a) + lawShearAlong(a, om) * sa * beta) +
               wb * (lawKappaAlong(b, t.layers.w, om, of_b) + lawShearAlong(b, om) * sb * beta);
    float mb = wa * (lawKappaAlong(a, t.layers.z, mm, 1.0f + a.e) + lawShearAlong(a, mm) * sa * beta + a.shear) +
               wb * (lawKappaAlong(b, t.layers.w, mm, 1.0f + b.e) + lawShearAlong(b, mm) * sb * beta + b.shear);
    float per = 1.0f / max(oa * mb - ob * ma, 1e-6f);
    float by_alpha = per * (ob * along_m - mb * along_off), by_beta = per * (ma * along_off - oa * along_m);
    float gains = by_alpha * om + by_beta * mm;
    float part = min(lawLaminateStep(a, sa * gains), lawLaminateStep(b, sb * gains));
    alpha += part * by_alpha;
    beta += part * by_beta;
  }
  out_.jump = alpha * off + beta * m;
  return out_;
}

/// Return the change of F, and of its cofactors, by a N^T. @param d  F - 1
LawColumns lawJumpColumns(vec3 a, vec3 n) { return lawColumns(n.x * a, n.y * a, n.z * a); }
LawColumns lawJumpCofactors(LawColumns d, vec3 a, vec3 n) {
  vec3 fa = vec3(1.0f, 0.0f, 0.0f) + d.a, fb = vec3(0.0f, 1.0f, 0.0f) + d.b, fc = vec3(0.0f, 0.0f, 1.0f) + d.c;
  return lawColumns(cross(a, n.y * fc - n.z * fb), cross(a, n.z * fa - n.x * fc), cross(a, n.x * fb - n.y * fa));
}

/// Returns dW/dF of both layers over their mean mu; sets their W over it. @param c, e  cofactors and dilation of d
LawColumns lawLaminateStress(CellMoments t, LawColumns d, LawColumns c, float e, float stiffening, OUT(float) density) {
  LawLaminate y = lawLaminate(t, d, c, e, stiffening);
  float ca = t.plane.w * t.layers.x, cb = (1.0f - t.plane.w) * t.layers.y, sa = 1.0f - t.plane.w, sb = -t.plane.w;
  density = ca * lawDensity(y.size_a, y.a.e, t.layers.z, stiffening) + cb * lawDensity(y.size_b, y.b.e, t.layers.w, stiffening);
  float shear_a = ca * y.a.shear, shear_b = cb * y.b.shear, of_c_a = ca * y.a.kappa - shear_a, of_c_b = cb * y.b.kappa - shear_b;
  float shear = shear_a + shear_b, of_jump = sa * shear_a + sb * shear_b, of_c = of_c_a + of_c_b, of_turn = sa * of_c_a + sb * of_c_b;
  LawColumns by = lawJumpColumns(y.jump, t.plane.xyz), turn = lawJumpCofactors(d, y.jump, t.plane.xyz);
  LawColumns p = lawColumns(shear * d.a + of_jump * by.a + of_c * c.a + of_turn * turn.a, shear * d.b + of_jump * by.b + of_c * c.b + of_turn * turn.b,
                            shear * d.c + of_jump * by.c + of_c * c.c + of_turn * turn.c);
  float kappa = ca * y.a.kappa + cb * y.b.kappa;
  p.a.x += kappa;
  p.b.y += kappa;
  p.c.z += kappa;
  return p;
}
