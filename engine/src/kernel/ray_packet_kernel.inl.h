// Which rays of a packet meet the box of a piece: LeafTrace::start (ray_kernel.inl.h) up to there, by the same operations,
// with the rays side by side. Needs Lanes<float>.

void rays_that_touch(const RayLeaf& leaf, RayPacket& rays, unsigned lanes) {
  using L = Lanes<float>;
  using Batch = L::Batch;
  constexpr unsigned group = (1u << L::width) - 1u;
  for (int first = 0; first < RayPacket::size; first += L::width) {
    if ((lanes >> first & group) == 0) continue;
    const auto load = [&](const float* from) { return L::load(from + first); };
    Batch d[3], from[3], away[3];
    for (int i = 0; i < 3; ++i) {
      d[i] = load(rays.direction[i]);
      from[i] = Batch(leaf.centre[i]) - load(rays.origin[i]);
    }
    const Batch shift = from[0] * d[0] + from[1] * d[1] + from[2] * d[2];
    for (int i = 0; i < 3; ++i) away[i] = L::fms(shift, d[i], from[i]);
    Batch enter = load(rays.near) - shift, leave = load(rays.far) - shift;
    for (int c = 0; c < 3; ++c) {
      const Batch x(leaf.axis_x[c]), y(leaf.axis_y[c]), z(leaf.axis_z[c]);
      const Batch slope = L::fma(x, d[0], L::fma(y, d[1], z * d[2]));
      const Batch along = xsimd::copysign(xsimd::max(xsimd::abs(slope), Batch(1e-18f)), slope);
      const Batch inverse = Batch(1.0f) / along;
      const Batch origin = L::fma(x, away[0], L::fma(y, away[1], z * away[2]));
      const Batch in = (Batch(leaf.lower[c]) - origin) * inverse, out = (Batch(leaf.upper[c]) - origin) * inverse;
      enter = xsimd::max(enter, xsimd::min(in, out)), leave = xsimd::min(leave, xsimd::max(in, out));
    }
    L::store(rays.touches + first, xsimd::select(enter <= leave, Batch(1.0f), Batch(0.0f)));
  }
}
