"""The static experiments of Cao, Chen, Hu and Liu (2023) on the virtual bench, with the truth beside every answer."""
