# What the pictures share.  A figure is drawn by
#   gnuplot -c FIGURE.gp DATA_DIRECTORY PICTURE_DIRECTORY
data = ARG1 . '/'
pictures = ARG2 . '/'
set encoding utf8
set border 3 lc rgb '#555555' lw 1
set tics nomirror out scale 0.6
set grid lc rgb '#DDDDDD' lw 0.6 dt 1
set key noenhanced samplen 1.6 spacing 1.05
set title noenhanced offset 0,-0.4
# Okabe and Ito's colours, told apart by colour-blind readers too.
set linetype 1 lc rgb '#0072B2' lw 1.6 pt 7
set linetype 2 lc rgb '#D55E00' lw 1.6 pt 5
set linetype 3 lc rgb '#009E73' lw 1.6 pt 9
set linetype 4 lc rgb '#CC79A7' lw 1.6 pt 13
set linetype 5 lc rgb '#E69F00' lw 1.6 pt 6
set linetype 6 lc rgb '#56B4E9' lw 1.6 pt 4
set linetype 7 lc rgb '#000000' lw 1.6 pt 8
set linetype 8 lc rgb '#7F6000' lw 1.6 pt 12
set linetype 9 lc rgb '#999999' lw 1.6 pt 10
set linetype cycle 9
# Numbers on an axis as one writes them; behind it goes `set ytics add ('0' 0)`.
powers = '%.1t·10^{%T}'
terminal(width, height) = sprintf("pngcairo size %d,%d enhanced font 'Sans,15' linewidth 1.4 pointscale 1.2 background rgb 'white'", width, height)
# The title of a block: its comment line.
greek = 'gsub(/alpha/, "α"); gsub(/beta/, "β"); gsub(/gamma/, "γ")'
name(file, i) = system(sprintf("awk '/^#/ { if (n++ == %d) { %s; print substr($0, 3) } }' '%s'", i, greek, file))
blocks(file) = int(system(sprintf("grep -c '^#' '%s'", file)))
