"""An ego in sumo-gamma's traffic, driven from Python: one file, the standard library alone.

    sumo-gamma drive SCENARIO -o DIR --seeds 1..10 --ego unix:ego.sock     # in one shell
    with Ego("unix:ego.sock") as env: ...                                   # in another

The calls are Gymnasium's. Where `gymnasium` can be imported, `action_space` is one of its spaces.
The protocol is in docs/ego.md.
"""

import json
import socket
import struct
import time

PROTOCOL = 1


class EgoError(Exception):
    """The other side refused a message, or is gone."""


class Ego:
    """One connection: as many episodes, one after the other, as the drive has seeds."""

    def __init__(self, address, patience=60.0):
        """`address`: unix:PATH or HOST:PORT. `patience`: for somebody to listen there [s]."""
        self._socket = _connect(address, patience)
        self._step = 0
        self.hello = self._ask({"type": "hello", "protocol": PROTOCOL})
        self.seeds = list(self.hello["seeds"])  # that are left
        self.limits = self.hello["limits"]
        self.action_space = _action_space(self.limits)

    def reset(self, *, seed=None, options=None):
        """Begins an episode: of a seed that is left, or of the next one. -> obs, info"""
        observation = self._ask({"type": "reset", "seed": seed})
        self.seeds.remove(observation["seed"])
        return self._taken(observation)

    def step(self, action):
        """`action`: an acceleration [m/s^2], (acceleration, front wheel angle [rad]), a list of
        points (time, x, y), or an action of the protocol. The world goes on until the next plan.
        -> obs, reward, terminated, truncated, info"""
        observation = self._ask({"type": "step", "step": self._step, "action": _action(action)})
        seen, info = self._taken(observation)
        return (seen, observation["reward"], observation["terminated"], observation["truncated"],
                info)

    def futures(self, plan, samples=10, ways="believed"):
        """Joint samples of where everybody is over 4 s, given accelerations of the ego, one a
        period. -> {"step", "agents", "samples": [{"gap": [...], "poses": [...]}]}. ways="true":
        by everybody's own way, which no planner can see: what a forecast could be at best."""
        return self._ask({"type": "futures", "plan": [float(a) for a in plan], "samples": samples, "ways": ways})

    def close(self):
        if self._socket is None:
            return
        try:
            self._ask({"type": "close"})
        except (EgoError, OSError):
            pass
        self._socket.close()
        self._socket = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def _taken(self, observation):
        self._step = observation["step"]
        info = {key: observation[key] for key in ("seed", "late", "progress", "outcome")}
        return observation, info

    def _ask(self, message):
        body = json.dumps(message, allow_nan=False).encode()
        self._socket.sendall(struct.pack(">I", len(body)) + body)
        (length,) = struct.unpack(">I", self._read(4))
        answer = json.loads(self._read(length))
        if answer["type"] == "error":
            raise EgoError(answer["what"])
        return answer

    def _read(self, count):
        parts = bytearray()
        while len(parts) < count:
            part = self._socket.recv(count - len(parts))
            if not part:
                raise EgoError("sumo-gamma is gone")
            parts += part
        return bytes(parts)


def _connect(address, patience):
    until = time.monotonic() + patience
    while True:
        try:
            if address.startswith("unix:"):
                made = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
                made.connect(address[len("unix:"):])
            else:
                host, port = address.rsplit(":", 1)
                made = socket.create_connection((host, int(port)))
                made.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            return made
        except (FileNotFoundError, ConnectionRefusedError):
            if time.monotonic() > until:
                raise
            time.sleep(0.1)


def _action(action):
    if isinstance(action, dict):
        return action
    try:
        values = list(action)
    except TypeError:
        return {"acceleration": float(action)}
    if values and hasattr(values[0], "__len__"):
        return {"trajectory": [[float(value) for value in point] for point in values]}
    names = ("acceleration", "steering")[: len(values)]
    return {name: float(value) for name, value in zip(names, values)}


def _action_space(limits):
    try:
        from gymnasium.spaces import Box
    except ImportError:
        return None
    return Box(-limits["max_deceleration"], limits["max_acceleration"], (1,))
