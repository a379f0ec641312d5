#!/usr/bin/env bash
# use.sh FOLDER ROOT: uses the packages as a user does. They are installed (ROOT empty) or
# unpacked below ROOT. FOLDER contains tests/consumer and python_test.py. Called by check.sh.
set -euo pipefail
folder=$1
root=$2
PATH=$root/usr/bin:$PATH
export LD_LIBRARY_PATH=$root/usr/lib LIBGL_ALWAYS_SOFTWARE=1
mkdir -p "$folder/home"
export HOME=$folder/home
cd "$folder"

step() { printf '== %s\n' "$*"; }

[ "$(command -v palpate)" = "$root/usr/bin/palpate" ]
palpate --version
for page in palpate palpate-demo; do gzip -t "$root/usr/share/man/man1/$page.1.gz"; done
[ -f "$root/usr/lib/udev/rules.d/70-palpate.rules" ]

step "recordings, and a quick report"
palpate synth --material silicone --seed 1 --seconds 6 --out train.csv
palpate synth --material silicone --seed 2 --seconds 6 --out test.csv
palpate report --quick --train train.csv --test test.csv --out report >/dev/null
[ -s report/index.html ]

step "three seconds of the window on a display in memory"
xvfb-run -a -s '-screen 0 1280x800x24' palpate-demo --seconds 3 --stats stats.json
grep -q '"ticks"' stats.json

step "a model as C"
palpate fit --recording train.csv --method random --out model.json >/dev/null
palpate export model.json --c model.c
cc -std=c99 -Wall -Wextra -Werror -c model.c

step "Python"
export PYTHONPATH=$root/usr/lib/python3/dist-packages
if python3 -c 'import numpy' 2>/dev/null; then
  PALPATE=$root/usr/bin/palpate python3 python_test.py
else
  step "skipped: numpy is not there"
fi

step "the consumer project"
python3 tests/consumer/check.py "$root/usr/bin/palpate" "$root/usr" "$folder" c++ "" system
