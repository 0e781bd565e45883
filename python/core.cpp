// The thin part of `import sumo_gamma` that is C++: the library's public headers, and nothing else.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <csignal>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "sumo_gamma/program.h"
#include "sumo_gamma/session.h"

namespace py = pybind11;

namespace {

using sumogamma::Column;
using sumogamma::Error;
using sumogamma::Session;
using sumogamma::VelocitySpace;

/// A session that tells where two threads use it at once: no GIL is held while it steps.
struct GuardedSession {
  GuardedSession(const std::vector<std::string>& words, int socket) : session(words, socket) {}
  Session session;
  std::atomic<bool> busy = false;
};

/// Holds a session for the time of a call.
class Use {
 public:
  explicit Use(GuardedSession& guarded) : guarded_(guarded) {
    if (guarded.busy.exchange(true))
      throw Error("session", "is in use by another thread; give each thread its own");
  }
  ~Use() { guarded_.busy = false; }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;
  Session* operator->() { return &guarded_.session; }

 private:
  GuardedSession& guarded_;
};

/// What keeps the memory of a session's columns valid for as long as an array shows it.
py::capsule owner_of(Session& session) {
  auto* held = new std::shared_ptr<const void>(session.hold());
  return {held, [](void* pointer) { delete static_cast<std::shared_ptr<const void>*>(pointer); }};
}

py::array make_array(const double* data, std::vector<py::ssize_t> shape,
                     std::vector<py::ssize_t> strides, py::handle owner, bool writable) {
  py::array result(py::dtype::of<double>(), std::move(shape), std::move(strides), data, owner);
  if (!writable) result.attr("flags").attr("writeable") = false;
  return result;
}

template <typename Value>
py::array array_of(Session& session, const Column<Value>& column, bool writable = false) {
  if (column.size() == 0) return py::array_t<double>(0);
  return make_array(column.data(), {static_cast<py::ssize_t>(column.size())},
                    {static_cast<py::ssize_t>(column.stride())}, owner_of(session), writable);
}

/// x and y lie side by side.
py::array pairs_of(Session& session, const Column<const double>& x) {
  const auto rows = static_cast<py::ssize_t>(x.size());
  if (rows == 0) return py::array_t<double>(std::vector<py::ssize_t>{0, 2});
  return make_array(x.data(), {rows, 2}, {static_cast<py::ssize_t>(x.stride()), sizeof(double)},
                    owner_of(session), false);
}

py::list texts(Session& session, std::string_view (Session::*text)(std::size_t) const) {
  py::list result;
  for (std::size_t row = 0; row < session.size(); ++row)
    result.append(py::str(std::string((session.*text)(row))));
  return result;
}

py::array driven_of(Session& session) {
  py::array_t<bool> result(static_cast<py::ssize_t>(session.size()));
  for (std::size_t row = 0; row < session.size(); ++row)
    result.mutable_data()[row] = session.driven(row);
  return result;
}

void bind_errors(py::module_& module) {
  static py::exception<Error> error(module, "Error", PyExc_RuntimeError);
  static py::exception<sumogamma::SumoError> sumo_error(module, "SumoError", error.ptr());
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(std::move(thrown));
    } catch (const sumogamma::SumoError& failure) {
      sumo_error(failure.what());
    } catch (const Error& failure) {
      error(failure.what());
    }
  });
}

// its arrays show its own memory, and keep it
void bind_velocity_space(py::module_& module) {
  const auto planes = [](py::object self, std::size_t offset) {
    const auto& space = self.cast<const VelocitySpace&>();
    const auto rows = static_cast<py::ssize_t>(space.planes.size());
    const auto* first = reinterpret_cast<const double*>(space.planes.data());
    return make_array(first + offset, {rows, 2}, {sizeof(VelocitySpace::HalfPlane), sizeof(double)},
                      self, false);
  };
  py::class_<VelocitySpace>(module, "VelocitySpace")
      .def_property_readonly("points", [planes](py::object self) { return planes(self, 0); })
      .def_property_readonly("normals", [planes](py::object self) { return planes(self, 2); })
      .def_property_readonly("foes",
                             [](py::object self) {
                               const auto& foes = self.cast<const VelocitySpace&>().foes;
                               py::array result(py::dtype::of<std::int64_t>(),
                                                {static_cast<py::ssize_t>(foes.size())}, {},
                                                foes.data(), self);
                               result.attr("flags").attr("writeable") = false;
                               return result;
                             })
      .def_readonly("kinds", &VelocitySpace::kinds)
      .def_readonly("hard", &VelocitySpace::hard)
      .def_property_readonly("preferred",
                             [](py::object self) {
                               const auto& space = self.cast<const VelocitySpace&>();
                               return make_array(space.preferred, {2}, {sizeof(double)}, self,
                                                 false);
                             })
      .def_property_readonly("chosen", [](py::object self) {
        const auto& space = self.cast<const VelocitySpace&>();
        return make_array(space.chosen, {2}, {sizeof(double)}, self, false);
      });
}

/// A property that reads a session.
template <typename Read>
auto reading(Read read) {
  return [read](GuardedSession& self) {
    Use use(self);
    return read(self.session);
  };
}

/// A call that computes, or waits for SUMO: others may run meanwhile.
template <typename Call>
auto computing(Call call) {
  return [call](GuardedSession& self) {
    const py::gil_scoped_release released;
    Use use(self);
    (self.session.*call)();
  };
}

using SessionClass = py::class_<GuardedSession>;

void bind_loop(SessionClass& session) {
  session
      .def(py::init([](const std::vector<std::string>& words, int socket) {
             const py::gil_scoped_release released;
             return std::make_unique<GuardedSession>(words, socket);
           }),
           py::arg("words"), py::arg("socket") = -1)
      .def("observe", computing(&Session::observe))
      .def("step", computing(&Session::step))
      .def("advance", computing(&Session::advance))
      .def("close", computing(&Session::close))
      .def_property_readonly("finished", reading([](Session& s) { return s.finished(); }))
      .def_property_readonly("time", reading([](Session& s) { return s.time(); }))
      .def_property_readonly("step_length", reading([](Session& s) { return s.step_length(); }))
      .def_property_readonly("state_hash", reading([](Session& s) { return s.state_hash(); }))
      .def(
          "prefer",
          [](GuardedSession& self, std::size_t row, double x, double y) {
            Use(self)->prefer(row, x, y);
          },
          py::arg("row"), py::arg("velocity_x"), py::arg("velocity_y"))
      .def(
          "velocity_space",
          [](GuardedSession& self, std::size_t row) { return Use(self)->velocity_space(row); },
          py::arg("row"))
      .def(
          "take", [](GuardedSession& self, const std::string& id) { Use(self)->take(id); },
          py::arg("vehicle"))
      .def(
          "_release", [](GuardedSession& self, const std::string& id) { Use(self)->release(id); },
          py::arg("vehicle"));
}

void bind_columns(SessionClass& session) {
  session.def("__len__", reading([](Session& s) { return s.size(); }))
      .def_property_readonly("ids", reading([](Session& s) { return texts(s, &Session::id); }))
      .def_property_readonly("types", reading([](Session& s) { return texts(s, &Session::type); }))
      .def_property_readonly("reasons",
                             reading([](Session& s) { return texts(s, &Session::reason); }))
      .def_property_readonly("driven", reading(driven_of))
      .def_property_readonly("positions", reading([](Session& s) { return pairs_of(s, s.x()); }))
      .def_property_readonly("velocities",
                             reading([](Session& s) { return pairs_of(s, s.velocity_x()); }))
      .def_property_readonly("headings",
                             reading([](Session& s) { return array_of(s, s.heading()); }))
      .def_property_readonly("speeds", reading([](Session& s) { return array_of(s, s.speed()); }))
      .def_property_readonly("radii", reading([](Session& s) { return array_of(s, s.radius()); }))
      .def_property_readonly("allowed_speeds", reading([](Session& s) {
                               return array_of(s, s.allowed_speed(), true);
                             }));
}

extern "C" void interrupt_by_signal(int) { sumogamma::interrupt_command(); }

/// Ctrl-C ends a command in good order, and Python hears of it afterwards.
std::pair<int, std::string> run_command(const std::vector<std::string>& words) {
  struct sigaction ours = {}, pythons = {};
  ours.sa_handler = interrupt_by_signal;
  sigaction(SIGINT, &ours, &pythons);
  sumogamma::CommandResult result;
  try {
    const py::gil_scoped_release released;
    result = sumogamma::run_command(words);
  } catch (...) {
    sigaction(SIGINT, &pythons, nullptr);
    throw;
  }
  sigaction(SIGINT, &pythons, nullptr);
  constexpr int kInterrupted = 130;
  if (result.exit_code == kInterrupted) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw py::error_already_set();
  }
  return {result.exit_code, std::move(result.output)};
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  bind_errors(module);
  bind_velocity_space(module);
  SessionClass session(module, "_Session");
  bind_loop(session);
  bind_columns(session);
  module.def("run_command", &run_command, py::arg("words"));
  module.attr("__version__") = sumogamma::version();
}
