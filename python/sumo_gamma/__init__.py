"""GAMMA traffic for Eclipse SUMO, from Python.

Commands of the program as functions: import_map, run, scene, predict. A loop of one's own: Session. Beside a loop over
TraCI: attach. Whatever the program would exit with 2 for raises Error, a SUMO that failed SumoError, Ctrl-C
KeyboardInterrupt.
"""
import json as _json
import os as _os
import tempfile as _tempfile

from ._core import Error, SumoError, VelocitySpace, _Session, __version__, run_command

__all__ = ["Error", "Session", "SumoError", "VelocitySpace", "attach", "import_map", "predict", "run", "run_command",
           "scene", "__version__"]

# given several times on the command line, where others take a list with commas
_REPEATED = {"method", "set", "take", "type"}


def _words(options):
    """Keyword arguments as words of the command line: trajectory_period=0 is --trajectory-period 0."""
    words = []
    for name, value in options.items():
        option = "--" + name.rstrip("_").replace("_", "-")
        if value is None or value is False:
            continue
        if isinstance(value, dict):
            value = [f"{key}={_text(entry)}" for key, entry in value.items()]
        if value is True:
            words.append(option)
        elif isinstance(value, (list, tuple, set, frozenset)):
            texts = [_text(entry) for entry in value]
            for text in texts if name in _REPEATED else [",".join(texts)]:
                words += [option, text]
        else:
            words += [option, _text(value)]
    return words


def _text(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(value) if isinstance(value, float) else str(value)


def _read(path):
    with open(path, encoding="utf-8") as stream:
        return _json.load(stream)


def import_map(map, output, **options):
    """Makes a scenario folder of an OpenStreetMap extract, as `sumo-gamma import`. Returns import.json."""
    run_command(["import", _os.fspath(map), "-o", _os.fspath(output)] + _words({"quiet": True, **options}))
    return _read(_os.path.join(output, "import.json"))


def run(scenario, output, **options):
    """Drives a scenario to its end, as `sumo-gamma run`. Returns results.json, with `held`: False where a condition of
    fail_on happened."""
    code, _ = run_command(["run", _os.fspath(scenario), "-o", _os.fspath(output)] +
                          _words({"quiet": True, **options}))
    return {**_read(_os.path.join(output, "results.json")), "held": code == 0}


def scene(file, **options):
    """Drives a standalone scene without roads, as `sumo-gamma scene`. Returns its figures."""
    return _json.loads(run_command(["scene", _os.fspath(file)] + _words({"quiet": True, **options}))[1])


def predict(files, **options):
    """Scores predictions on recordings, as `sumo-gamma predict`. Returns what it writes with --json."""
    files = [files] if isinstance(files, (str, _os.PathLike)) else files
    with _tempfile.TemporaryDirectory() as folder:
        path = _os.path.join(folder, "predict.json")
        run_command(["predict", *map(_os.fspath, files), "--json", path] + _words({"quiet": True, **options}))
        return _read(path)


class Session(_Session):
    """A run whose loop is the user's own:

        with sumo_gamma.Session("city", duration=60) as session:
            while not session.finished:
                session.drive()

    drive() is observe(), step() and advance(); what is one's own comes between the first two. Options are those of
    `sumo-gamma run`; without output= nothing is written. Arrays show the scene in place, without a copy, up to the
    next observe(); afterwards they keep what they showed.
    """

    def __init__(self, scenario, *, socket=-1, **options):
        super().__init__([_os.fspath(scenario)] + _words(options), socket)
        self._gives_all_back = False

    def drive(self, decide=None):
        """One step. `decide`, if given, is called with the session between observe() and step()."""
        self.observe()
        if self._gives_all_back:
            self._release_driven()
        if decide is not None:
            decide(self)
        self.step()
        self.advance()

    def release(self, vehicle=None):
        """Hands a vehicle back to SUMO, as soon as SUMO can take it. Where none is given, all that GAMMA drives, and
        by drive() whoever comes from then on."""
        if vehicle is not None:
            self._release(vehicle)
            return
        self._gives_all_back = True
        self._release_driven()

    def _release_driven(self):
        for identifier, driven, kind in zip(self.ids, self.driven, self.types):
            if driven and kind != "pedestrian":
                self._release(identifier)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def attach(traci, scenario=None, **options):
    """Joins the SUMO of a user's own loop over TraCI. Two lines more in it hand its agents to GAMMA:

        gamma = sumo_gamma.attach(traci)            # after traci.start(...)
        while traci.simulation.getMinExpectedNumber() > 0:
            gamma.drive()                           # before every traci.simulationStep()
            traci.simulationStep()

    `traci`: the module, or one of its connections. `scenario`: SUMO's own configuration where none is given. Options
    are those of `sumo-gamma run` that concern who is driven and how: control="car", take=..., seed=..., threads=...
    gamma.release() hands all vehicles back, gamma.take(id) and gamma.release(id) one.
    """
    connection = traci.getConnection() if hasattr(traci, "getConnection") else traci
    socket = getattr(connection, "_socket", None)
    if socket is None:
        raise Error(f"attach: {getattr(traci, '__name__', traci)} has no connection to share; use traci, or a Session "
                    "with backend='libsumo'")
    option = connection.simulation.getOption
    scenario = scenario or option("configuration-file")
    if not scenario:
        raise Error("attach: SUMO was started without a configuration file; give scenario='FILE.sumocfg'")
    options.setdefault("step", option("step-length"))
    return Session(scenario, socket=socket.fileno(), **options)
