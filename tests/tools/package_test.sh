#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# package_test.sh BUILD SOURCE: installs sinew into an empty folder; the example programs find and link it,
# and they and the installed programs run.
set -euo pipefail

build=${1:?usage: package_test.sh BUILD SOURCE}
source=${2:?usage: package_test.sh BUILD SOURCE}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/installed" >/dev/null

cmake -S "$source/lib/examples" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_FLAGS_RELEASE=-O0 -DCMAKE_PREFIX_PATH="$work/installed" >/dev/null
cmake --build "$work/build" >/dev/null
cd "$work"
cat > box.yaml <<END
body: {mesh: $source/data/meshes/box.obj, count: 300}
skeleton:
  bones:
    - {name: lower, head: [0, 0, 0], tail: [0, 0, 0.34648]}
    - {name: upper, parent: lower, tail: [0, 0, 0.69296]}
motion:
  tracks:
    - bone: upper
      keys: [{time: 0}, {time: 0.1, axis: [0, 1, 0], angle: 20}]
solver: {duration: 0.1}
END
build/fill_mesh "$source/data/meshes/box.obj" body.vtu | grep -E '^[45][0-9]{3} particles of radius 0\.00'
build/bend_box box.yaml frames | grep -E '^4 frames of [23][0-9]{2} particles$'
test "$(grep -c '<DataSet' frames/particles.pvd)" = 4
build/measure_run box.yaml run | grep -E '^tip 1[5-9]\.|^tip 2[0-5]\.'
test "$(wc -l < run/bones.csv)" = 9  # two bones, four frames, and the names
build/own_force box.yaml | grep -E '^mean displacement [0-9.e-]+ m along x$'
if [ -e "$work/installed/include/sinew/vtk" ]; then
  "$source/tests/tools/on_display.sh" build/vtk_scene bent.png
  /usr/bin/python3 -c '
from vtkmodules.vtkIOImage import vtkPNGReader
reader = vtkPNGReader()
reader.SetFileName("bent.png")
reader.Update()
colors = reader.GetOutput().GetPointData().GetScalars()
drawn = [sum(colors.GetTuple(i)) < 3 * 255 for i in range(colors.GetNumberOfTuples())]
assert 0.05 < sum(drawn) / len(drawn) < 0.8, sum(drawn) / len(drawn)'
fi
if build/fill_mesh missing.obj body.vtu 2>error.txt; then exit 1; else test $? = 2; fi
grep -q missing.obj error.txt

if cmake --build "$build" --target help | grep "^sinew_python:" >/dev/null; then
  PYTHONPATH=$(echo "$work"/installed/lib/python3.*/dist-packages) /usr/bin/python3 -c '
import sinew
assert "/installed/lib/python3." in sinew.__file__, sinew.__file__'
fi
"$work/installed/bin/sinew" --version
"$work/installed/bin/sinew" info --help >/dev/null
test -s "$work/installed/share/sinew/paraview/sinew_paraview.py"  # which sinew view --live loads
"$source/tools/install_packages.sh" --list test | grep -x libqt5svg5 >/dev/null  # icons of ParaView's buttons
