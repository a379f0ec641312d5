# A replayed recording: measured force, differences over the JND, error against force.
# Reads replay.csv, replay_bins.csv, replay_models.csv.
reset
load "replay.set"
load "style.gp"
jnd_mN(x) = 1000 * (jnd_offset_N + jnd_fraction * x)
set lmargin at screen 0.08
set rmargin at screen 0.86
strip = 70.0 / height
do for [medium in media] {
  eval open(medium, "replay")
  set multiplot
  unset label
  unset logscale
  set grid noytics nomytics
  set xrange [from_s:to_s]
  set tmargin at screen 1 - 24.0 / height
  set bmargin at screen 1 - 110.0 / height
  set format x ""
  unset xlabel
  set ylabel "Force [N]"
  set yrange [*:*]
  decade = 10 ** floor(log10(force_high))
  set ytics force_high / decade < 2 ? decade / 2 : force_high / decade < 5 ? decade : 2 * decade
  set label 1 "measured" at graph 1.015,0.5 left textcolor rgb green
  set label 2 title_text at graph 0,1.1 left noenhanced textcolor rgb ink
  plot "replay.csv" using 1:3 with lines linewidth 2 linecolor rgb green
  unset label
  do for [m = 0:models - 1] {
    set xrange [*:*]
    set yrange [*:*]
    stats "replay_models.csv" using 3 every ::m::m nooutput
    set xrange [from_s:to_s]
    hue = hexadecimal(STATS_max)
    strip_name = system(sprintf("sed -n %dp replay_models.csv | cut -d, -f2", m + 2))
    set tmargin at screen 1 - 118.0 / height - m * strip
    set bmargin at screen 1 - 118.0 / height - (m + 1) * strip + 8.0 / height
    set yrange [-limit:limit]
    set ytics (-1, 0, 1)
    set ylabel m == int(models / 2) ? "Difference [JND]" : ""
    if (m == models - 1) {
      set format x "%g"
      set xlabel "Time [s]"
    }
    set label 1 strip_name at graph 1.015,0.5 left noenhanced textcolor rgb hue
    plot '+' using 1:(-1):(1) with filledcurves fillcolor rgb band fillstyle solid noborder, \
      "replay.csv" using 1:(column(4 + m)) with lines linewidth 1.3 linecolor rgb hue
  }
  unset label
  set grid xtics ytics mxtics mytics
  set tmargin at screen 165.0 / height
  set bmargin at screen 62.0 / height
  set xrange [0:force_high]
  set yrange [error_low:*]
  set logscale y
  set ytics autofreq
  set xlabel "Measured force [N]"
  set ylabel "Mean + std [mN]"
  plot '+' using 1:(error_low):(jnd_mN($1)) with filledcurves fillcolor rgb band fillstyle solid noborder, \
    "replay_bins.csv" using "force_N":"error_mN":"colour" with linespoints pointtype 7 pointsize 0.5 linewidth 1.5 linecolor rgb variable
  unset multiplot
  unset output
}
