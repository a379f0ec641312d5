"""compare.py A.csv B.csv: fails if the forces in the last columns differ by more than 1e-9 N."""
import csv
import sys


def forces(path):
    with open(path, newline="") as table:
        return [float(row[-1]) for row in list(csv.reader(table))[1:]]


a, b = forces(sys.argv[1]), forces(sys.argv[2])
if len(a) != len(b) or not a:
    sys.exit("%d forces here, %d there" % (len(a), len(b)))
largest = max(abs(x - y) for x, y in zip(a, b))
print("%s: %d forces, largest difference %.2g N" % (sys.argv[1], len(a), largest))
sys.exit(0 if largest <= 1e-9 else "beyond 1e-9 N")
