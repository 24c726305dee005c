call 'benchmarks/paper/common.gp' ARG1 ARG2
eval 'set terminal ' . terminal(1500, 960)
set output pictures . 'figure_7.png'
# Five steps; the legend takes the sixth place.
files = system(sprintf("ls '%s'figure_7_*.dat | grep -v _0.2.dat | sort -t_ -k3 -g", data))
set multiplot layout 2,3 margins 0.07,0.985,0.07,0.95 spacing 0.06,0.12
set logscale y
set format y '10^{%L}'
set ytics 1e4
set mytics 1
set xlabel 't' offset 0,0.6
set xrange [0:122]
set yrange [1e-22:1e-3]
set key off
do for [f in files] {
  set title 'h = ' . system(sprintf("basename '%s' .dat | cut -d_ -f3", f))
  plot for [i = 0:blocks(f) - 1] f index i using 1:(abs($2)) with lines lt i + 1
}
set title '|H - H(0)| against t'
set key center center Left reverse
unset border
unset tics
unset xlabel
unset grid
f = word(files, 1)
plot for [i = 0:blocks(f) - 1] NaN with lines lt i + 1 title name(f, i)
unset multiplot
