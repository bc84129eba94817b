//! Quantities in the text of a document ("5 um/min") and their values in µm, s and pN.
