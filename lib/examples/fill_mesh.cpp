// SPDX-License-Identifier: GPL-3.0-or-later
// fill_mesh MESH BODY.vtu: fills a mesh with about 5,000 closest-packed particles, for ParaView.
#include <sinew/sinew.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: fill_mesh MESH BODY.vtu\n"), 2;
  try {
    sinew::BodyOptions body;
    body.mesh = argv[1];
    const sinew::Surface surface = sinew::read_surface(body);

    sinew::PackOptions packing;
    packing.count = 5000;
    const sinew::Filling filling = sinew::pack(surface, packing);

    sinew::write_body(argv[2], sinew::body_file(filling));
    std::printf("%zu particles of radius %g m fill %g m^3\n", filling.particles.size(),
                filling.particles.radius, filling.report.volume);
  } catch (const sinew::Error& error) {
    return std::fprintf(stderr, "%s\n", error.what()), static_cast<int>(error.exit());
  }
}
