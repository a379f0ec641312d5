# Figures of merit of the main models with their 95 % intervals. Reads evidence.csv.
reset
load "evidence.set"
load "style.gp"
set grid noytics nomytics
unset ylabel
do for [medium in media] {
  eval open(medium, "evidence")
  set multiplot layout 1,4 margins 0.275,0.985,60.0 / height,0.97 spacing 0.04,0
  do for [c = 0:3] {
    unset arrow
    unset label
    value_at = 5 + 3 * c
    moved = 17 + c
    floor_at = c == 0 ? floor_beyond : c == 1 ? floor_p99 : c == 2 ? floor_rms_mN : 0
    unset logscale
    set xrange [*:*]
    set yrange [*:*]
    stats "evidence.csv" using (column(value_at + 2)) nooutput
    highest = STATS_max
    stats "evidence.csv" using (column(value_at)) nooutput
    lowest = STATS_min > 0 ? STATS_min : highest * 1e-3
    lowest = c == 0 ? (lowest < 0.003 ? 0.003 : lowest) : lowest
    least = floor_at > 0 && floor_at < lowest ? floor_at : lowest
    least = least < highest * 1e-5 ? lowest : least
    set yrange [rows - 0.4:-0.6]
    set logscale x
    set xrange [least * 0.7:highest * 1.4]
    set xtics autofreq font ",13"
    set format x "%g"
    set xlabel (c == 0 ? "beyond JND [%]" : c == 1 ? "99 % up to [JND]" : c == 2 ? "RMS [mN]" : "worst [JND]") font ",13"
    if (c == 0) {
      set ytics out scale 0 offset 0.5,0 font ",13"
    } else {
      set ytics scale 0 format ""
    }
    if (floor_at > least * 0.7) { set arrow 1 from first floor_at,graph 0 to first floor_at,graph 1 nohead dashtype 3 linewidth 2 linecolor rgb muted }
    if ((c == 1 || c == 3) && least * 0.7 < 1 && highest * 1.4 > 1) { set arrow 2 from first 1,graph 0 to first 1,graph 1 nohead dashtype 2 linewidth 1.5 linecolor rgb muted }
    shown(x) = x > least * 0.7 ? x : least * 0.75
    if (c == 0) {
      plot "evidence.csv" using (shown(column(value_at))):"row":(shown(column(value_at + 1))):(shown(column(value_at + 2))):"colour":ytic(2) with xerrorbars pointtype 0 linewidth 1.6 linecolor rgb variable, \
        "" using (shown(column(value_at))):"row":"colour" with points pointtype 7 pointsize 0.8 linecolor rgb variable, \
        "" using (strcol("recipe") eq "paper" ? shown(column(value_at)) : NaN):"row" with points pointtype 7 pointsize 0.45 linecolor rgb paper, \
        "" using (shown(column(moved))):"row":"colour" with points pointtype 2 pointsize 0.8 linewidth 1.4 linecolor rgb variable
    } else {
      plot "evidence.csv" using (shown(column(value_at))):"row":(shown(column(value_at + 1))):(shown(column(value_at + 2))):"colour" with xerrorbars pointtype 0 linewidth 1.6 linecolor rgb variable, \
        "" using (shown(column(value_at))):"row":"colour" with points pointtype 7 pointsize 0.8 linecolor rgb variable, \
        "" using (strcol("recipe") eq "paper" ? shown(column(value_at)) : NaN):"row" with points pointtype 7 pointsize 0.45 linecolor rgb paper, \
        "" using (shown(column(moved))):"row":"colour" with points pointtype 2 pointsize 0.8 linewidth 1.4 linecolor rgb variable
    }
  }
  unset multiplot
  unset output
}
