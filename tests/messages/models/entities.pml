<?xml version="1.0"?>
<!DOCTYPE physicalModel [
<!ENTITY a "lol"><!ENTITY b "&a;&a;&a;">
]>
<physicalModel name="&b;"/>
