#!/usr/bin/env bash
# The main job on the simulated scan in testdata/: import, fit, validate, draw. Usage: demo.sh BBRF
set -euo pipefail
cd "$(dirname "$0")/.."
bbrf=$1
rm -rf demo
mkdir -p demo

step() { printf '\n%s\n' "$*"; }

step '1. Import 272 raw PR-650 records, white reference and dark signal (testdata/simulated_scan/scan.csv)'
"$bbrf" import testdata/simulated_scan/scan.csv -o demo/scan.bbrf

step '2. Fit a Lambertian and a Torrance-Sparrow term, without a starting point'
"$bbrf" fit demo/scan.bbrf -o demo/fitted.bbrf

step '3. Validate the file'
"$bbrf" validate demo/fitted.bbrf

step '4. Draw it'
"$bbrf" report demo/fitted.bbrf -o demo/report.html --figures demo

step 'What lies where'
printf '  %s\n' demo/*
