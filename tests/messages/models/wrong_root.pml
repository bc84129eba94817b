<?xml version="1.0"?>
<sbml level="3"><model/></sbml>
