"""A parameter sweep: the same demand with ever longer time gaps between cars.

usage: sweep.py SCENARIO FOLDER
"""
import os
import sys

import sumo_gamma


def main(scenario, folder):
    print("headway [s]  mean speed [m/s]  arrived")
    for headway in (0.8, 1.2, 2.0):
        results = sumo_gamma.run(scenario, os.path.join(folder, f"headway_{headway}"), duration=60, seed=1,
                                 set={"types.car.headway": headway})
        print(f"{headway:11.1f}  {results['flow']['mean_speed']:16.2f}  {results['agents']['arrived']:7d}")


if __name__ == "__main__":
    main(*sys.argv[1:3])
