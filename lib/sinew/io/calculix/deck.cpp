// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/calculix/deck.h>

#include <string>
#include <string_view>

#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/io/particle_formats/detail/writers.h>

namespace sinew {
namespace {

constexpr std::size_t numbers_per_line = 10;

std::string_view type_of(ElementKind kind) {
  switch (kind) {
    case ElementKind::hexahedron8:
      return "C3D8I";
    case ElementKind::hexahedron20:
      return "C3D20";
    case ElementKind::tetrahedron4:
      return "C3D4";
    case ElementKind::tetrahedron10:
      return "C3D10";
  }
  return "";
}

void write_nodes(NewFile& file, const Deck& deck) {
  const Vec3& origin = deck.origin;
  if (!origin.isZero(0)) {
    std::string told = "** meters from";
    for (const double coordinate : origin) told += ' ' + number_text(coordinate);
    write_text(file, told + '\n');
  }
  write_text(file, "*NODE, NSET=ALL\n");
  write_rows(file, deck.mesh.nodes.size(), [&](std::string& text, std::size_t i) {
    const Vec3 p = deck.mesh.nodes[i] - origin;
    put_row(text, ',', i + 1, short_place(p.x()), short_place(p.y()), short_place(p.z()));
  });
}

void write_elements(NewFile& file, const VolumeMesh& mesh) {
  std::string head = "*ELEMENT, ELSET=BODY, TYPE=";
  head += type_of(mesh.elements.front().kind);
  write_text(file, head + '\n');
  write_rows(file, mesh.elements.size(), [&](std::string& text, std::size_t e) {
    put_value(text, e + 1);
    std::size_t on_line = 1;
    for (const std::uint32_t node : mesh.elements[e].used()) {
      text += on_line++ % numbers_per_line == 0 ? ",\n" : ",";
      put_value(text, node + 1);
    }
    text += '\n';
  });
}

void write_numbers(NewFile& file, const std::vector<std::uint32_t>& numbers) {
  write_rows(file, numbers.size(), [&](std::string& text, std::size_t k) {
    put_value(text, numbers[k] + 1);
    text += (k + 1) % numbers_per_line == 0 || k + 1 == numbers.size() ? ",\n" : ",";
  });
}

/// A name of the scene within a comment line.
std::string comment_line(const std::string& name) {
  std::string line = "** ";
  for (const char letter : name) line += letter >= ' ' && letter <= '~' ? letter : '?';
  return line + '\n';
}

void write_materials(NewFile& file, const std::vector<DeckMaterial>& materials) {
  for (std::size_t k = 0; k < materials.size(); ++k) {
    const DeckMaterial& material = materials[k];
    const std::string name = "MATERIAL_" + std::to_string(k);
    write_text(file, comment_line(material.name) + "*ELSET, ELSET=" + name + '\n');
    write_numbers(file, material.elements);
    std::string text = "*MATERIAL, NAME=" + name + "\n*ELASTIC\n";
    put_row(text, ',', short_number(material.young_modulus), short_number(material.poisson_ratio));
    text += "*DENSITY\n" + short_number(material.density) + '\n';
    ((text += "*SOLID SECTION, ELSET=") += name) += ", MATERIAL=";
    (text += name) += '\n';
    write_text(file, text);
  }
}

std::string set_name(std::size_t k) { return "SUPPORT_" + std::to_string(k); }

void write_sets(NewFile& file, const std::vector<DeckSet>& sets) {
  for (std::size_t k = 0; k < sets.size(); ++k) {
    write_text(file, comment_line(sets[k].name) + "*NSET, NSET=" + set_name(k) + '\n');
    write_numbers(file, sets[k].nodes);
  }
}

/// The first step takes a second that ends at its time: whatever acts then, acts from rest.
std::string step_head(const Deck& deck, std::size_t k) {
  constexpr const char* first_part = "0.25";
  const double end = deck.steps[k].time;
  const double length = k == 0 ? (end > 0 ? end : 1) : end - deck.steps[k - 1].time;
  std::string text = deck.large_displacements ? "*STEP, NLGEOM, INC=10000\n" : "*STEP\n";
  text +=
      k == 0 ? "*STATIC, TOTAL TIME AT START=" + short_number(end - length) + '\n' : "*STATIC\n";
  put_row(text, ',',
          short_number(deck.large_displacements ? std::stod(first_part) * length : length),
          short_number(length));
  return text;
}

void write_held(NewFile& file, const std::vector<HeldNode>& held) {
  write_text(file, "*BOUNDARY, OP=NEW\n");
  write_rows(file, held.size(), [&](std::string& text, std::size_t k) {
    put_row(text, ',', held[k].node + 1, held[k].axis + 1, held[k].axis + 1,
            short_number(held[k].displacement));
  });
}

void write_forces(NewFile& file, const std::vector<NodeForce>& forces) {
  write_text(file, "*CLOAD, OP=NEW\n");
  write_rows(file, forces.size(), [&](std::string& text, std::size_t k) {
    for (int axis = 0; axis < 3; ++axis)
      if (forces[k].force[axis] != 0)
        put_row(text, ',', forces[k].node + 1, axis + 1, short_number(forces[k].force[axis]));
  });
}

void write_pressures(NewFile& file, const std::vector<FacePressure>& pressures) {
  write_text(file, "*DLOAD, OP=NEW\n");
  write_rows(file, pressures.size(), [&](std::string& text, std::size_t k) {
    put_row(text, ',', pressures[k].face.element + 1,
            "P" + std::to_string(pressures[k].face.face + 1), short_number(pressures[k].pressure));
  });
}

void write_modes(NewFile& file, const Deck& deck) {
  std::vector<HeldNode> still = deck.steps.front().held;
  for (HeldNode& node : still) node.displacement = 0;
  write_text(file, "*STEP\n*FREQUENCY\n" + std::to_string(deck.frequencies) + '\n');
  write_held(file, still);
  write_text(file, "*NODE FILE\nU\n*END STEP\n");
}

void write_step(NewFile& file, const Deck& deck, std::size_t k) {
  write_text(file, step_head(deck, k));
  write_held(file, deck.steps[k].held);
  write_forces(file, deck.steps[k].forces);
  write_pressures(file, deck.steps[k].pressures);
  std::string text =  // at the end of the step alone
      "*NODE FILE, FREQUENCY=1000000\nU, RF\n*EL FILE, FREQUENCY=1000000\nS\n";
  for (std::size_t set = 0; set < deck.sets.size(); ++set)
    text += "*NODE PRINT, NSET=" + set_name(set) + ", TOTALS=ONLY, FREQUENCY=1000000\nRF\n";
  write_text(file, text + "*END STEP\n");
}

}  // namespace

void write_deck(const std::filesystem::path& path, const Deck& deck) {
  NewFile file(path);
  write_text(file, "*HEADING\n" + comment_line(deck.title).substr(3));
  write_nodes(file, deck);
  write_elements(file, deck.mesh);
  write_materials(file, deck.materials);
  write_sets(file, deck.sets);
  if (deck.frequencies > 0)
    write_modes(file, deck);
  else
    for (std::size_t k = 0; k < deck.steps.size(); ++k) write_step(file, deck, k);
  file.finish();
}

}  // namespace sinew
