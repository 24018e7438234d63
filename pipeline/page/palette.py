"""The colours of pages and their pictures: everybody can tell them apart (Okabe and Ito 2008)."""

BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY = "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"
GREY, BLACK = "#6b6b6b", "#000000"
SERIES = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, GREY, BLACK)
