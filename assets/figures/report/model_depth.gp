# What the model says of the material. Reads model_depth.csv and model_depth_spectrum.csv.
reset
load "model_depth.set"
load "style.gp"
do for [medium in media] {
  eval open(medium, "model_depth")
  set multiplot layout 2,2
  set tmargin 1
  set rmargin 8
  unset label
  unset logscale
  set xrange [*:*]
  set yrange [0:*]
  set xlabel "Depth [mm]"
  set ylabel "Elastic force [N]"
  plot "model_depth.csv" using "depth_mm":"elastic_N" with lines linewidth 2 linecolor rgb blue
  set ylabel "Stiffness [N/mm]"
  set label 1 "slow" at graph 0.03,0.93 left textcolor rgb blue
  set label 2 "fast" at graph 0.03,0.80 left textcolor rgb vermilion
  plot "model_depth.csv" using "depth_mm":"elastic_stiffness_N_per_mm" with lines linewidth 2 linecolor rgb blue, \
    "" using "depth_mm":"instantaneous_stiffness_N_per_mm" with lines linewidth 2 linecolor rgb vermilion
  set ylabel "Viscosity [Ns/m]"
  plot "model_depth.csv" using "depth_mm":"viscosity_slow_Ns_per_m" with lines linewidth 2 linecolor rgb blue, \
    "" using "depth_mm":"viscosity_fast_Ns_per_m" with lines linewidth 2 linecolor rgb vermilion
  unset label
  set xlabel "Relaxation time [s]"
  set ylabel "Relaxing [N/mm]"
  if (branches > 0) {
    set logscale x
    set xrange [0.005:20]
    plot "model_depth_spectrum.csv" using 1:2 with impulses linewidth 4 linecolor rgb blue, \
      "" using 1:2 with points pointtype 7 pointsize 0.8 linecolor rgb blue
  } else {
    set xrange [0:1]
    set label 1 "no Maxwell branch" at graph 0.5,0.5 center textcolor rgb muted
    plot NaN
  }
  unset multiplot
  unset output
}
