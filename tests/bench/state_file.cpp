// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cstdint>
#include <fstream>
#include <string>

#include <sinew/core/error.h>

#include "bench/state_file.h"

namespace sinew::bench {
namespace {

constexpr std::array columns{&Particles::x, &Particles::y, &Particles::z,
                             &Particles::u, &Particles::v, &Particles::w};

}  // namespace

std::filesystem::path state_path(const std::filesystem::path& folder, Condition condition,
                                 std::size_t count) {
  std::string name(name_of(condition));
  name += '_';
  name += std::to_string(count);
  name += ".state";
  return folder / name;
}

void write_state(const std::filesystem::path& path, const Particles& particles) {
  std::ofstream file(path, std::ios::binary);
  const std::uint64_t count = particles.size();
  file.write(reinterpret_cast<const char*>(&count), sizeof count);
  for (const auto column : columns)
    file.write(reinterpret_cast<const char*>((particles.*column).data()),
               static_cast<std::streamsize>(count * sizeof(double)));
  if (!file.flush()) throw not_written(path.string(), "the state does not fit", "make room for it");
}

Particles read_state(const std::filesystem::path& path, const Scene& scene) {
  std::ifstream file(path, std::ios::binary);
  std::uint64_t count = 0;
  file.read(reinterpret_cast<char*>(&count), sizeof count);
  Particles particles = scene.start;
  if (!file || count != particles.size())
    throw bad_input(path.string() + " holds " + std::to_string(count) + " particles instead of " +
                        std::to_string(particles.size()),
                    "make it again with make_state");
  for (const auto column : columns)
    file.read(reinterpret_cast<char*>((particles.*column).data()),
              static_cast<std::streamsize>(count * sizeof(double)));
  if (!file) throw bad_input(path.string() + " ends early", "make it again with make_state");
  return particles;
}

}  // namespace sinew::bench
