#!/usr/bin/python3
"""Prints a table of runs: print_table.py DIR..."""

import sys

from runs import Run


def print_columns(rows):
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        print("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip())


def fall_rows(runs):
    rows = [["scene", "body", "mode", "descent [m/s]", "drift [m/s]", "turns", "overturns", "swings"]]
    for run in runs:
        for track in run.tracks:
            fall = track.entry.get("fall")
            if fall:
                rows.append(
                    [
                        run.name,
                        track.name,
                        fall["mode"],
                        f"{fall['descent_speed']:.2f}",
                        f"{fall['drift_speed']:.2f}",
                        f"{fall['turns']:g}",
                        str(fall["overturns"]),
                        str(fall["swings"]),
                    ]
                )
    return rows


def path_rows(runs):
    rows = [["scene", "body", "time [s]", "end x, y, z [m]", "path [m]", "top speed [m/s]", "lands at x, y [m]"]]
    for run in runs:
        for track in run.tracks:
            if track.entry.get("fall") or track.entry["mass"] == 0:
                continue
            path, end = track.entry["path"], track.entry["end"]
            landing = path["landing"]
            rows.append(
                [
                    run.name,
                    track.name,
                    f"{end['time']:g}",
                    ", ".join(f"{value:.2f}" for value in end["position"]),
                    f"{path['length']:.2f}",
                    f"{path['largest_speed']:.2f}",
                    ", ".join(f"{value:.2f}" for value in landing["position"][:2])
                    + f" after {landing['time']:.2f} s"
                    if landing
                    else "-",
                ]
            )
    return rows


def main():
    runs = [Run(folder) for folder in sys.argv[1:]]
    for rows in (fall_rows(runs), path_rows(runs)):
        if len(rows) > 1:
            print()
            print_columns(rows)


if __name__ == "__main__":
    main()
