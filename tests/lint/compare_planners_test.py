"""Checks the arithmetic of tools/compare_planners.py on drives whose figures are known.

usage: compare_planners_test.py PROJECT_FOLDER
"""
import csv
import os
import subprocess
import sys
import tempfile

COLUMNS = {"outcome": "goal", "contact": 0, "contact_at_fault": 0, "restricted_time_s": 10.0, "speed_change_per_m": 0.5, "mean_speed": 4.0,
           "score_without_comfort": 0.9, "plans": 30, "driven_m": 50.0, "gridlock": 0, "contact_moving": 0, "near_miss": 0,
           "mean_acceleration": 0.3, "mean_jerk": 0.5, "braking_share": 0.1, "braking_of_others_s": 0.0, "delay_of_others_s": 0.0,
           "time_to_collision": 1.0, "score": 0.8}


def write_drive(out, site, planner, episodes):
    """episodes: by seed what differs from a quiet one."""
    folder = os.path.join(out, site, planner)
    os.makedirs(folder)
    with open(os.path.join(folder, "episodes.csv"), "w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, ["seed", *COLUMNS])
        table.writeheader()
        for seed, different in episodes.items():
            table.writerow({"seed": seed, **COLUMNS, **different})


def row_of(text, *begin):
    """Cells of the last row whose first cells are so."""
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("| ")]
    return [row for row in rows if row[: len(begin)] == list(begin)][-1]


def main():
    tool = os.path.join(sys.argv[1], "tools", "compare_planners.py")
    with tempfile.TemporaryDirectory() as out:
        for site in ("a", "b"):
            # the base meets somebody in 1 of 10, the other one in 9 of 10, and takes 2 s longer on every seed
            write_drive(out, site, "pomdp-gamma", {s: {"contact": int(s == 1), "restricted_time_s": 10 + s % 3} for s in range(1, 11)})
            other = {s: {"contact": int(s != 2), "restricted_time_s": 12 + s % 3} for s in range(1, 11)}
            other[11] = {}  # a seed that the base hasn't driven
            write_drive(out, site, "policy", other)
        write_drive(out, "c", "pomdp-gamma", {s: {"gridlock": int(s < 3)} for s in range(1, 7)})
        write_drive(out, "c", "policy", {s: {"outcome": "client_failed"} if s == 6 else {} for s in range(1, 7)})
        answer = subprocess.run([tool, out], capture_output=True, text=True, check=True).stdout
        assert "**a**, 10 seeds (0 locked up" in answer and "**c**, 3 seeds (2 locked up" in answer, answer
        assert "**pooled**, 23 seeds (2 locked up" in answer, answer
        base = answer.split("**a**")[1]
        # Wilson's interval of 1 in 10; 1 contact in 300 plans, in half a kilometre
        assert row_of(base.split("**b**")[0], "pomdp-gamma")[1:6] == ["10.0 [1.8, 40.4]", "3.33", "2.00", "0", "100.0"], answer
        of_a = answer.split("**a**: less")[1].split("**b**")[0]
        # 8 alone of one, none of the other: mid-p 2 (1/256 / 2), times 3 by Holm
        assert row_of(of_a, "policy", "collisions")[2].startswith("+80.00 points"), of_a
        assert row_of(of_a, "policy", "collisions")[4:] == ["0.008", "pomdp-gamma is better"], of_a
        assert row_of(of_a, "policy", "time to goal [s]")[2] == "+2.00 [+2.00, +2.00]", of_a
        assert row_of(of_a, "policy", "speed change [m/s per m]")[4:] == ["1.000", "not told apart"], of_a
        every = subprocess.run([tool, out, "--all"], capture_output=True, text=True, check=True).stdout
        assert every.startswith("23 seeds (2 locked up"), every
        # 2 in 23 of one, 18 of the other, both on seed 1 alone (phi 0.163): Newcombe's interval by hand
        contacts = row_of(every, "**collisions**, %")
        assert contacts[1:3] == ["8.7 [2.4, 26.8]", "78.3 [58.1, 90.3]"], contacts
        assert contacts[3] == "+69.6 [+44.8, +82.2], 0.000", contacts
        assert row_of(every, "goal reached, %")[3] == "+0.0 [-14.3, +14.3], 1.000", every
        assert row_of(every, "collisions per km driven")[1:3] == ["1.74", "15.65"], every
        empty = subprocess.run([tool, os.path.join(out, "a", "policy")], capture_output=True, text=True, check=False)
        assert empty.returncode != 0 and "no SITE/PLANNER" in empty.stderr, empty.stderr
    print("compare_planners: figures, intervals and p as worked out by hand")


if __name__ == "__main__":
    main()
