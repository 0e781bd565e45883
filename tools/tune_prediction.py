#!/usr/bin/env python3
"""Chooses the predictor's parameters on declared training recordings, by coordinate descent, and prints them.

usage: tune_prediction.py --program build/sumo-gamma --kind walker eth.csv hotel.csv univ003.csv zara1.csv cross.csv
       tune_prediction.py --program build/sumo-gamma --kind wheels --noise 0.02 cross.csv
       ... --leave-one-out: once for each recording, tuned on the others and scored on it
       ... --from-present: starts from the program's own parameters, not from round guesses

The score is the mean over recordings of ADE and FDE (protocol C), each divided by that of constant velocity, plus what
COL exceeds the truth's own by. Everything is deterministic: the same recordings give the same parameters. Wheels are
tuned with 2 cm of noise on what is observed, because CROSS is smoothed by low polynomials whose high derivatives
foretell the future (docs/prediction.md).
"""
import argparse
import json
import os
import subprocess
import tempfile

# what is tuned: the value to start from, a round guess that has seen no data, and the first factor to move it by;
# all else is fixed by hand
FREE = {
    "walker": {"noise_scale": (5, 1.5), "noise_power": (1.5, 1.3), "observation_noise": (0.01, 1.5),
               "acceleration_variance": (0.3, 1.7), "acceleration_time": (0.3, 1.5), "velocity_drift": (0.03, 1.5),
               "acceleration_decay": (1, 1.5), "speed_decay": (0.03, 1.8), "prior_keep_velocity": (0.3, 2),
               "prior_turn": (0.2, 2), "prior_stop": (0.05, 2), "change_of_mind": (0.05, 1.7),
               "flow_distance": (1.5, 1.25), "flow_speed": (0.3, 1.25), "flow_prior": (4, 1.5),
               "companion_distance": (1.5, 1.3), "companion_speed": (0.3, 1.4), "companion_weight": (0.5, 2)},
    "wheels": {"acceleration_variance": (1, 1.7), "acceleration_time": (1, 1.7), "velocity_drift": (0.01, 1.6),
               "acceleration_decay": (1, 1.5), "speed_decay": (0.005, 1.8), "turn_decay": (1.5, 1.6),
               "stop_time": (1, 1.5), "prior_keep_velocity": (0.3, 2), "prior_turn": (0.3, 2), "prior_stop": (0.05, 2),
               "likelihood_deviation": (0.1, 1.5), "change_of_mind": (0.05, 1.7), "flow_distance": (1.5, 1.25),
               "flow_speed": (0.6, 1.25), "flow_prior": (4, 1.5)},
}
LEAST_STEP = 1.08  # a factor below this is no longer tried


def predict(options, recordings, methods, parameters):
    """Figures of the program: {(set, method): evaluation}."""
    with tempfile.NamedTemporaryFile(suffix=".json") as file:
        command = [options.program, "predict", *recordings, "--quiet", "--method", ",".join(methods), "--json", file.name]
        if options.noise > 0:
            command += ["--noise", str(options.noise)]
        for name, value in parameters.items():
            command += ["--set", f"predict.{name}={value!r}"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        report = json.load(open(file.name, encoding="utf-8"))
    return {(e["set"], e["method"]): e for e in report["evaluations"]}


class Score:
    def __init__(self, options, recordings):
        self.options, self.recordings = options, recordings
        self.reference = predict(options, recordings, ["cv"], {})
        self.calls = 0

    def __call__(self, parameters):
        self.calls += 1
        total = 0.0
        for (name, _), e in predict(self.options, self.recordings, ["gamma"], parameters).items():
            cv = self.reference[name, "cv"]
            total += 0.5 * (e["ade"] / cv["ade"] + e["fde"] / cv["fde"])
            total += 2.0 * max(0.0, e["collision_rate"] - max(e["true_collision_rate"], 0.012))
        return total / len(self.recordings)


def start_of(options):
    """Where the search begins: round guesses, or the program's own parameters."""
    names = {f"{options.kind}.{name}": start for name, (start, _) in FREE[options.kind].items()}
    if not options.from_present:
        return names
    listed = subprocess.run([options.program, "predict", "--parameters"], check=True, capture_output=True, text=True)
    present = dict(line.removeprefix("predict.").split("=") for line in listed.stdout.split())
    return {name: float(present[name]) for name in names}


def tune(options, recordings):
    """Coordinate descent with shrinking factors; returns the parameters and their score."""
    score = Score(options, recordings)
    changed = start_of(options)
    best = score(changed)
    steps = {f"{options.kind}.{name}": factor for name, (_, factor) in FREE[options.kind].items()}
    for sweep in range(options.sweeps):
        for name, factor in steps.items():
            if factor < LEAST_STEP:
                continue
            for value in (changed[name] * factor, changed[name] / factor):
                trial = {**changed, name: float(f"{value:.4g}")}
                result = score(trial)
                if result < best - 1e-5:
                    best, changed = result, trial
                    break
            else:
                steps[name] = factor ** 0.5
        print(f"# sweep {sweep + 1}: {best:.5f} after {score.calls} runs", flush=True)
    return changed, best


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", nargs="+")
    parser.add_argument("--program", required=True)
    parser.add_argument("--kind", choices=sorted(FREE), default="walker")
    parser.add_argument("--noise", type=float, default=0.0)
    parser.add_argument("--from-present", action="store_true")
    parser.add_argument("--sweeps", type=int, default=4)
    parser.add_argument("--leave-one-out", action="store_true")
    parser.add_argument("--also", nargs="*", default=[], help="recordings that stay in training with --leave-one-out")
    options = parser.parse_args()
    if not options.leave_one_out:
        changed, best = tune(options, options.recordings)
        print(f"# score {best:.5f} on {', '.join(os.path.basename(r) for r in options.recordings)}")
        for name, value in changed.items():
            print(f"predict.{name}={value}")
        return
    for left_out in options.recordings:
        others = [r for r in options.recordings if r != left_out]
        changed, _ = tune(options, others + options.also)
        for (name, method), e in predict(options, [left_out], ["gamma", "cv"], changed).items():
            print(f"{name} {method}: {e['ade']:.4f}/{e['fde']:.4f} COL {e['collision_rate']:.4f}")
        print("  " + " ".join(f"{k}={v}" for k, v in changed.items()), flush=True)


if __name__ == "__main__":
    main()
