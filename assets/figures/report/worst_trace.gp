# The worst seconds: measured force, and every model's difference from it over the JND.
# Reads worst_trace.csv and worst_trace_strips.csv (which columns belong to which strip).
reset
load "worst_trace.set"
load "style.gp"
set xrange [from_s:to_s]
set lmargin at screen 0.09
set rmargin at screen 0.86
top = 0.98
# Out of contact there is no figure: the line breaks.
shown(c) = valid(c) ? column(c) : NaN
bottom = 74.0 / height
force_height = (top - bottom) * 1.6 / (strips + 1.6)
strip_height = (top - bottom) / (strips + 1.6)
do for [medium in media] {
  eval open(medium, "worst_trace")
  set multiplot
  unset label
  set tmargin at screen top
  set bmargin at screen top - force_height + 0.02
  set format x ""
  unset xlabel
  set ylabel "Force [N]"
  set yrange [*:*]
  set xrange [*:*]
  stats "worst_trace.csv" using 3 nooutput
  set xrange [from_s:to_s]
  set ytics tic_step(STATS_max, 2)
  set grid noytics nomytics
  set label 1 "measured" at graph 1.015,0.5 left textcolor rgb green
  plot "worst_trace.csv" using 1:3 with lines linewidth 2 linecolor rgb green
  do for [s = 0:strips - 1] {
    set xrange [*:*]
    set yrange [*:*]
    stats "worst_trace_strips.csv" using 3 every ::s::s nooutput
    hue = hexadecimal(STATS_max)
    stats "worst_trace_strips.csv" using 4 every ::s::s nooutput
    first = int(STATS_max)
    stats "worst_trace_strips.csv" using 5 every ::s::s nooutput
    last = int(STATS_max)
    strip_name = system(sprintf("sed -n %dp worst_trace_strips.csv | cut -d, -f2", s + 2))
    set xrange [from_s:to_s]
    unset label
    set tmargin at screen top - force_height - s * strip_height
    set bmargin at screen top - force_height - (s + 1) * strip_height + 0.012
    set yrange [-limit:limit]
    set ytics ("-1" -1, "" 0, "1" 1)
    set ylabel s == int(strips / 2) ? "Difference [JND]" : ""
    if (s == strips - 1) {
      set format x "%g"
      set xlabel "Time [s]"
    }
    set label 1 strip_name at graph 1.015,0.5 left noenhanced textcolor rgb hue
    if (first == last) {
      plot '+' using 1:(-1):(1) with filledcurves fillcolor rgb band fillstyle solid noborder, \
        "worst_trace.csv" using 1:(shown(last)) with lines linewidth 1.6 linecolor rgb hue
    } else {
      plot '+' using 1:(-1):(1) with filledcurves fillcolor rgb band fillstyle solid noborder, \
        "worst_trace.csv" using 1:(shown(first)) with lines linewidth 0.7 linecolor rgb muted, \
        "" using 1:(shown(last)) with lines linewidth 1.6 linecolor rgb hue
    }
  }
  unset multiplot
  unset output
}
