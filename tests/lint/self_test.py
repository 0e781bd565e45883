"""Proves that each lint can fail: feeds it small projects with one fault each and expects that complaint.

usage: self_test.py
"""
import os
import shutil
import subprocess
import sys
import tempfile

LINTS = ("layers", "words", "format", "scripts", "functions", "traffic", "page")
HERE = os.path.dirname(os.path.abspath(__file__))
MODULES = """
sumogamma_module(base)
sumogamma_module(geometry DEPENDS base)
sumogamma_module(model DEPENDS geometry)
sumogamma_module(traffic DEPENDS model)
sumogamma_module(osm DEPENDS geometry)
sumogamma_module(sumo DEPENDS geometry)
sumogamma_program(town app DEPENDS sumo)
sumogamma_embed(io kReplayPageJs replay/a.js replay/b.js)
"""
UNFINISHED = "TO" + "DO"
MACHINE = "/wo" + "rk/main"
# what the rules of the road remember, a rule that reads it and one that writes it
STATE = """#pragma once
struct TrafficState {
  std::vector<double> wait;  ///< [s]
  std::vector<LanePosition> aim;
};
"""
READER = """double read(const TrafficState& state, std::size_t row) {
  const double& entry = state.wait[row];
  const std::vector<double>& all = state.wait;
  // state.wait[row] = 1.0;
  if (state.wait[row] == entry || state.wait[row] <= 1.0 || state.wait[row] >= 2.0) return 1.0;
  return all.size() + state.wait[std::size_t{row}] - state.wait[row];
}
"""
WRITER = "void write(TrafficState& state, std::size_t row) { state.wait[row] = 1.0; }\n"
BODY = "  f();\n"
GOOD = {
    "CMakeLists.txt": MODULES,
    "src/base/units.h": "#pragma once\n",
    "src/geometry/vec2.h": '#pragma once\n\n#include <vector>\n\n#include "base/units.h"\n',
    "src/osm/reader.cpp": "#include <osmium/io/any_input.hpp>\n",
    "src/sumo/libsumo_backend.cpp": "#include <libsumo/libsumo.h>\n",
    "src/app/main.cpp": '#include "base/units.h"\n#include "geometry/vec2.h"\n\nint main() { return 0; }\n',
    "src/model/model.cpp": '#include "geometry/vec2.h"\n',
    "src/traffic/traffic_state.h": STATE,
    "src/traffic/traffic_state.cpp": '#include "traffic/traffic_state.h"\nvoid append(TrafficState& state) { state.wait.push_back(0.0); }\n',
    "src/traffic/parameters.h": "#pragma once\ninline constexpr double kGap = 4.0;  ///< [s]\n",
    "src/traffic/patience.cpp": READER + WRITER,
    "src/traffic/rules/gaps.cpp": READER,
    "src/io/replay/a.js": "const one = await 1;\nif (!one) return;\n",
    "src/io/replay/b.js": "const two = one + 1;\n",
    "tools/hello.sh": "#!/usr/bin/env bash\nset -euo pipefail\necho hello\n",
}
# lint, file and what is put there, what the lint must say (None: nothing)
FAULTS = [
    ("layers", "src/geometry/vec2.h", '#include "sumo/backend.h"\n', "src/geometry/vec2.h:1: module geometry may not know sumo"),
    ("layers", "src/base/units.h", '#include "geometry/vec2.h"\n', "src/base/units.h:1: module base may not know geometry"),
    ("layers", "src/osm/reader.cpp", '#include "sumo/backend.h"\n', "module osm may not know sumo"),
    ("layers", "src/app/main.cpp", "#include <osmium/io/any_input.hpp>\n", "osmium/io/any_input.hpp belongs to src/osm"),
    ("layers", "src/app/version_command.cpp", "#include <osmium/osm/box.hpp>\n", "belongs to src/osm"),
    ("layers", "src/app/other_command.cpp", "#include <osmium/version.hpp>\n", "belongs to src/osm"),
    ("layers", "src/sumo/traci_backend.cpp", "  #  include <libsumo/libsumo.h>\n", "belongs to src/sumo/libsumo_backend"),
    ("layers", "src/sumo/clock.cpp", "#include <libtraci/libtraci.h>\n", "its client dies with SUMO"),
    ("layers", "src/sumo/draw.cpp", "#include <random>\n", "draws come from base/random.h"),
    ("layers", "src/geometry/save.cpp", "#include <fstream>\n", "module geometry does without <fstream>"),
    ("layers", "src/base/run.cpp", "int f() { return std::system(name); }\n", "src/base/run.cpp:1: no shell is started"),
    ("layers", "src/base/run.cpp", "auto* pipe = popen(name);\n", "src/base/run.cpp:1: no shell is started"),
    ("layers", "src/base/run.cpp", "spawn({\"/bin/sh\", name});\n", "src/base/run.cpp:1: no shell is started"),
    ("layers", "src/base/run.cpp", "coordinate_system(name); a.system(b);\n", None),
    ("layers", "src/extra/new.cpp", "int x;\n", "folder extra is no module"),
    ("layers", "src/base/lost.cpp", '#include "lost.h"\n', '"lost.h" is no file under src/'),
    ("layers", "src/base/units.h", "int unit();\n", "src/base/units.h: a header begins with #pragma once"),
    ("layers", "src/base/units.cpp", '#include <string>\n#include "base/units.h"\n', "src/base/units.cpp: its own header units.h comes first"),
    ("layers", "src/base/units.cpp", '#include "base/units.h"\n#include <string>\n', None),
    ("layers", "CMakeLists.txt", "sumogamma_module(base DEPENDS geometry)\n" + MODULES, "which is not declared above it"),
    ("layers", "src/model/model.cpp", '#include "traffic/parameters.h"\n', "src/model/model.cpp:1: module model may not know traffic"),
    ("layers", "src/traffic/z_state.h", "#pragma once\nstruct TrafficState final {\n};\n", "src/traffic/z_state.h:2: TrafficState is a type of src/traffic/traffic_state.h, too"),
    ("layers", "src/traffic/z_state.h", "#pragma once\nusing TrafficState = int;\n", "TrafficState is a type of"),
    ("layers", "src/traffic/z_state.h", "#pragma once\nnamespace a {\nusing TrafficState = int;\n}  // namespace a\nstruct Other;\n", None),
    ("functions", "src/base/units.h", "void f() {\n" + 60 * BODY + "}\n", "src/base/units.h:1: f has 61 lines"),
    ("functions", "src/base/a.cpp", "namespace a {\n\nint A::f(int b,\n         int c) const {\n" + 61 * BODY + "}\n\n}\n", "src/base/a.cpp:3: A::f has 62"),
    ("functions", "src/base/a.cpp", "void f(int a, std::map<int, int> b, int c, int d, int e, int g, int h) {\n}\n", "f has 7 parameters"),
    ("traffic", "src/traffic/rules/a.cpp", "constexpr double kA = 1.0;\n", "src/traffic/rules/a.cpp:1: kA belongs into src/traffic/parameters.h"),
    ("traffic", "src/traffic/rules/a.h", "  constexpr int kNone = kA,\n    kB = 12;\n", "src/traffic/rules/a.h:2: kB belongs"),
    ("traffic", "src/traffic/rules/a.cpp", "constexpr double kTiny = 1e-4;\n", None),
    *[("traffic", "src/traffic/rules/a.cpp", f"bool f(const View& view) {{\n  {body}\n}}\n", "src/traffic/rules/a.cpp:2: a clock is compared with seconds")
      for body in ("return view.traffic.waiting_time[row] > 4.0;", "return view.held[row].standing < parameters.soon;", "return kLong <= waiting->halted_at;",
                   "return view.time - view.halted_at[foe.row] > 0.5;", "return a && (3.0 < view.held[rows[0]].blocked || b);",
                   "double& kept = view.keeps_clear[row]; return kept >= view.parameters.stuck;", "return view.held[row].blocked > enough(parameters, row);")],
    *[("traffic", "src/traffic/rules/a.cpp", f"bool f(const View& view) {{\n  {body}\n}}\n", None)
      for body in ("return view.waiting_time[row] > 0.0;", "return view.halted_at[0] < view.halted_at[1];", "return waited(view, row) > Patience::Calm;",
                   "const double own = a.halted_at, their = b.halted_at; return own < their || (own == their && id < 3);",
                   "return blocked(view, 1) == Patience::Calm && speed > parameters.slow_walk;", "return view.blocked && speed > 1.0;")],
    ("traffic", "src/traffic/patience.cpp", READER + WRITER + "bool f(const V& v) { return v.waiting_time[1] > 3.0; }\n", None),
    ("traffic", "src/traffic/traffic_state.h", "struct Other {\n};\n", "no struct TrafficState"),
    *[("traffic", "src/traffic/rules/gaps.cpp", READER + f"void g(TrafficState& state, std::size_t row) {{ {change} }}\n",
       "src/traffic/traffic_state.h:3: wait has 2 writers, one at the most: src/traffic/patience, src/traffic/rules/gaps")
      for change in ("state.wait[row] = 2.0;", "state.wait[other[row]] += dt;", "++state.wait[row];", "state.wait[row]--;", "double& w = state.wait[row];",
                     "state.wait.assign(3, 0.0);", "auto* w = &state.wait;", "for (double& w : state.wait) w = 0.0;", "auto& [w] = state.wait[row];",
                     "view.state->wait.back() = 0.0;", "std::vector<double>& all = state.wait;")],
    ("traffic", "src/traffic/perception.h", "void f() { grid.visit_within(0, 1.0, visit); }\n", None),
    ("traffic", "src/traffic/perception.h", 2 * "void f() { grid.visit_within(0, 1.0, visit); }\n",
     "src/traffic/perception.h:2: a neighbour query of its own"),
    ("traffic", "src/traffic/rules/a.cpp", "void f() { grid.visit_within(0, 1.0, visit); }\n", "src/traffic/rules/a.cpp:1: a neighbour query of its own"),
    ("traffic", "src/traffic/rules/a.cpp", "void f() { visit_storey(view, 0, p, 1.0, visit); }\n", "src/traffic/rules/a.cpp:1: visit_storey asks"),
    ("traffic", "src/traffic/a.cpp", "void g(TrafficState& state) { state.aim[0].offset = 0.0; }\nvoid h() {}\n", None),
    ("words", "src/base/units.h", f"// {UNFINISHED}: later\n", "src/base/units.h:1: unfinished: " + UNFINISHED),
    ("words", "tools/hello.sh", f"ls {MACHINE}\n", "tools/hello.sh:1: a path of one machine"),
    ("words", "README.md", f"see {MACHINE}\n", "README.md:1: a path of one machine"),
    ("format", "src/base/units.h", "int  f( int x ){return x ;}\n", "src/base/units.h:1: not as clang-format-14"),
    ("scripts", "tools/hello.sh", "#!/usr/bin/env bash\nrm $1\n", "SC2086"),
    ("scripts", "tools/hello.sh", "#!/usr/bin/env bash\nif true; then\n", "syntax error"),
    ("page", "src/io/replay/a.js", "const one = 1;\nconst two = ;\n", "SyntaxError"),
    ("page", "src/io/replay/b.js", "const one = 2;\n", "'one' has already been declared"),
    ("page", "src/io/replay/forgotten.js", "const three = 3;\n", "not embedded"),
    ("scripts", "tools/not_executable.sh", "#!/usr/bin/env bash\necho hello\n", "needs its executable bit"),
]


def lay(root, files):
    for path, text in files.items():
        full = os.path.join(root, path)
        os.makedirs(os.path.dirname(full), exist_ok=True)
        with open(full, "w", encoding="utf-8") as file:
            file.write(text)
        if path == "tools/hello.sh":
            os.chmod(full, 0o755)


def run(lint, files):
    with tempfile.TemporaryDirectory() as root:
        shutil.copy(os.path.join(HERE, "../../.clang-format"), root)
        lay(root, files)
        found = subprocess.run([sys.executable, "-B", os.path.join(HERE, lint + ".py"), root],
                               capture_output=True, text=True, check=False)
        return found.returncode, found.stdout + found.stderr


def main():
    complaints = []
    for lint in LINTS:
        code, said = run(lint, GOOD)
        if code not in (0, 77):
            complaints.append(f"{lint} complains about a good project:\n{said}")
        if run(lint, {})[0] == 0:
            complaints.append(f"{lint} is content with an empty folder")
    for lint, path, text, wanted in FAULTS:
        code, said = run(lint, {**GOOD, path: text})
        if code == 77:
            print(f"skipped one fault: {said.strip()}")
        elif code != (wanted is not None) or (wanted or "") not in said:
            complaints.append(f"{lint} ended with {code} on {path} = {text!r}, expected a complaint '{wanted}':\n{said}")
    print("\n".join(complaints))
    print(f"self-test: {len(FAULTS)} faults planted, {len(complaints)} complaints")
    sys.exit(1 if complaints else 0)


main()
