#!/usr/bin/env bash
# What bbrf makes of the simulated experiment of the paper. Usage: paper.sh BBRF DIR, after `paper simulate DIR`.
set -euo pipefail
cd "$(dirname "$0")/.."
bbrf=$1
dir=$2

# What is measured once per object is said once per object: only warnings and results are of interest here.
quietly() { "$@" 2>"$dir/messages.txt" || { cat "$dir/messages.txt" >&2; return 1; }; }

echo 'Figs 2 and 3: the luminescence of each object under the black light, in the band in which it radiates'
for object in "$dir"/black-light/*/; do
    case $object in *red*) band=590-650 ;; *) band=500-580 ;; esac
    quietly "$bbrf" import "$object/scan.csv" -o "$object/scan.bbrf" >/dev/null
    quietly "$bbrf" fit "$object/scan.bbrf" --terms lambertian --reduce "band:$band" --json -o "$object/fitted.bbrf" >"$object/fit.json"
    quietly "$bbrf" export "$object/scan.bbrf" --measurement radiance --to csv -o "$object/spectra.csv"
    quietly "$bbrf" report "$object/fitted.bbrf" --figures "$object/figures" >/dev/null
done

echo 'Fig. 4: the matte white, and each object with what it reflects, under visible light'
for object in "$dir"/white-light/*/; do
    quietly "$bbrf" import "$object/scan.csv" -o "$object/scan.bbrf" >/dev/null
    quietly "$bbrf" fit "$object/scan.bbrf" --json -o "$object/fitted.bbrf" >"$object/fit.json"
    quietly "$bbrf" export "$object/scan.bbrf" --measurement scan --to csv -o "$object/spectra.csv"
    quietly "$bbrf" report "$object/fitted.bbrf" --figures "$object/figures" >/dev/null
done

echo 'Fig. 5: the matrix of the yellow paint from its spectra under two lamps'
lamps=$dir/two-lamps
for lamp in incandescent artificial-sun; do
    quietly "$bbrf" import "$lamps/$lamp/scan.csv" -o "$lamps/$lamp/scan.bbrf" >/dev/null
done
quietly "$bbrf" donaldson estimate \
    --under "$lamps/incandescent/lamp.csv=$lamps/incandescent/scan.bbrf#scan" \
    --under "$lamps/artificial-sun/lamp.csv=$lamps/artificial-sun/scan.bbrf#scan" \
    --id lumi-yellow --json -o "$dir/lumi-yellow.bbrf" >"$dir/estimate.json"
quietly "$bbrf" report "$dir/lumi-yellow.bbrf" --figures "$dir/figures" >/dev/null

echo 'Every file is valid'
quietly "$bbrf" validate "$dir"/*/*/fitted.bbrf "$dir/lumi-yellow.bbrf" >/dev/null

# The scene is given beside the matrix and the lamp, which it names relative to itself.
echo 'Fig. 6: the sphere, painted with that matrix, under the artificial sun'
cp examples/paper/sphere.toml "$dir/sphere.toml"
quietly "$bbrf" render "$dir/sphere.toml" -o "$dir/sphere" >/dev/null
