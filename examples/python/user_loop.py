"""A loop over TraCI as many have one. The two marked lines hand its agents over to GAMMA; the rest takes them back.

usage: user_loop.py FILE.sumocfg
"""
import sys

import traci
import sumo_gamma


def vehicles_of(gamma):
    return sum(driven and kind != "pedestrian" for driven, kind in zip(gamma.driven, gamma.types))


def main(config):
    traci.start(["sumo", "-c", config, "--step-length", "0.1", "--no-step-log", "true"])
    gamma = sumo_gamma.attach(traci)  # <- hands the agents over
    seen = set()
    while traci.simulation.getTime() < 60:
        gamma.drive()  # <- moves them
        traci.simulationStep()
        seen.update(traci.vehicle.getIDList())  # all of TraCI goes on as ever
    before = vehicles_of(gamma)
    gamma.release()  # takes all vehicles back, each as soon as SUMO can go on with it
    while traci.simulation.getTime() < 120:
        gamma.drive()
        traci.simulationStep()
    after = vehicles_of(gamma)
    gamma.close()
    traci.close()
    print(f"{len(seen)} vehicles seen in 60 s; {before} of them GAMMA's then, {after} at 120 s")


if __name__ == "__main__":
    main(sys.argv[1])
