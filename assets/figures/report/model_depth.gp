# What the model says of the material. Reads model_depth.csv and model_depth_spectrum.csv.
reset
load "model_depth.set"
load "style.gp"
array names[5] = ["", "elastic_N", "instantaneous_stiffness_N_per_mm", "viscosity_slow_Ns_per_m", ""]
do for [medium in media] {
  eval open(medium, "model_depth")
  set multiplot layout 2,2
  set tmargin 1
  set rmargin 4
  set lmargin 9
  do for [p = 1:3] {
    unset logscale
    unset label
    set xrange [*:*]
    set yrange [*:*]
    stats "model_depth.csv" using names[p + 1] nooutput
    highest = STATS_max
    stats "model_depth.csv" using "depth_mm" nooutput
    set xrange [0:STATS_max]
    set xtics tic_step(STATS_max, 5)
    set yrange [0:(highest > 0 ? 1.1 * highest : 1)]
    set ytics tic_step(highest, 4)
    set xlabel "Depth [mm]"
    set ylabel (p == 1 ? "Elastic force [N]" : p == 2 ? "Stiffness [N/mm]" : "Viscosity [Ns/m]")
    if (p > 1 && highest > 0) {
      set label 1 "slow" at graph 0.03,0.92 left textcolor rgb blue
      set label 2 "fast" at graph 0.03,0.78 left textcolor rgb vermilion
    }
    if (highest <= 0) { set label 3 "no viscous term" at graph 0.5,0.5 center textcolor rgb muted }
    if (p == 1) { plot "model_depth.csv" using "depth_mm":"elastic_N" with lines linewidth 2 linecolor rgb blue }
    if (p == 2) {
      plot "model_depth.csv" using "depth_mm":"elastic_stiffness_N_per_mm" with lines linewidth 2 linecolor rgb blue, \
        "" using "depth_mm":"instantaneous_stiffness_N_per_mm" with lines linewidth 2 linecolor rgb vermilion
    }
    if (p == 3) {
      plot "model_depth.csv" using "depth_mm":(highest > 0 ? column("viscosity_slow_Ns_per_m") : NaN) with lines linewidth 2 linecolor rgb blue, \
        "" using "depth_mm":(highest > 0 ? column("viscosity_fast_Ns_per_m") : NaN) with lines linewidth 2 linecolor rgb vermilion
    }
  }
  unset label
  set xrange [0:1]
  set yrange [0:1]
  set xlabel "Relaxation time [s]"
  set ylabel "Relaxing [N/mm]"
  if (branches > 0) {
    set xrange [*:*]
    set yrange [*:*]
    stats "model_depth_spectrum.csv" using 2 nooutput
    set yrange [0:1.1 * STATS_max]
    set ytics tic_step(STATS_max, 4)
    set logscale x
    set xrange [spectrum_low:spectrum_high]
    set xtics 10
    set format x "%g"
    plot "model_depth_spectrum.csv" using 1:2 with impulses linewidth 4 linecolor rgb blue, \
      "" using 1:2 with points pointtype 7 pointsize 0.8 linecolor rgb blue
    unset logscale
    set format x "% h"
  } else {
    set label 1 "no Maxwell branch" at graph 0.5,0.5 center textcolor rgb muted
    plot NaN
  }
  unset multiplot
  unset output
}
