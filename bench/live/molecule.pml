# A peptide as cartoon, sticks, spheres and a surface, which turns.
viewport 800, 600
fab ACDEFGHIKLMNPQRSTVWY, peptide, ss=1
show cartoon
show sticks, resi 1-8
show spheres, resi 9-12
show surface, resi 13-20
set transparency, 0.4
orient
mset 1x360
movie.roll 1, 360, 1, axis=y
mplay
