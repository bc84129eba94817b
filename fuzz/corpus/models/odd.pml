<physicalModel name="odd &amp; old " nrOfAtoms="5" author="A. N. &quot;Other&quot;" xmlns:my="urn:mine" my:flag="1">
<informativeComponents><multiComponent name="Informative Components ">
  <structuralComponent name="labels" mode="POINTS" weight="2"><atomRef index="70"/><atomRef index="3"/></structuralComponent>
</multiComponent></informativeComponents>
<exclusiveComponents level="1"><multiComponent name="Exclusive Components " young="15000">
  <multiComponent name="nested"><structuralComponent name="facets">
    <color r="0.8" g="0.25" b="0.2" a="1"/>
    <cell><cellProperties index="4" type="TRIANGLE" phymulType="elastic"/><nrOfStructures value="3"/>
      <atomRef index="70"/><atomRef index="3"/><atomRef index="9"/></cell>
    <cell><cellProperties type="QUAD" name="q"/><color r="0" g="0" b="1" a="0.5"/>
      <atomRef index="70"/><atomRef index="3"/><atomRef index="9"/><atomRef index="0"/></cell>
  </structuralComponent></multiComponent>
</multiComponent></exclusiveComponents>
<atoms><structuralComponent name="list">
  <atom><atomProperties index="70" x="-1e-3" y="0.1" z="123456789.125" mass="100"/></atom>
  <atom><atomProperties index="3" x="1" y="0" z="0" name="a &lt; b"/></atom>
  <atom><atomProperties index="9" x="0" y="1" z="0"/></atom>
  <atom><atomProperties index="0" x="0" y="0" z="1"/></atom>
</structuralComponent></atoms>
</physicalModel>
