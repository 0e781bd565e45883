"""A loop over TraCI as many have one. The two marked lines hand its agents over to GAMMA; the rest takes them back.

usage: user_loop.py FILE.sumocfg
"""
import sys

import traci
import sumo_gamma


def main(config):
    traci.start(["sumo", "-c", config, "--step-length", "0.1", "--no-step-log", "true"])
    gamma = sumo_gamma.attach(traci)  # <- hands the agents over
    seen = set()
    while traci.simulation.getTime() < 60:
        gamma.drive()  # <- moves them
        traci.simulationStep()
        seen.update(traci.vehicle.getIDList())  # all of TraCI goes on as ever
    driven = int(gamma.driven.sum())
    gamma.release()  # all vehicles are SUMO's again, each as soon as SUMO can take it
    while traci.simulation.getTime() < 120:
        gamma.drive()
        traci.simulationStep()
    handed_back = driven - int(gamma.driven.sum())
    gamma.close()
    traci.close()
    print(f"{len(seen)} vehicles seen, {driven} agents driven at 60 s, {handed_back} fewer at 120 s")


if __name__ == "__main__":
    main(sys.argv[1])
