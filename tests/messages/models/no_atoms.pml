<physicalModel name="test">
<atoms><structuralComponent name="atoms">
</structuralComponent></atoms>
<exclusiveComponents><multiComponent name="all">
<structuralComponent name="skin">
  <cell><cellProperties type="TRIANGLE"/><atomRef index="0"/><atomRef index="2"/><atomRef index="1"/></cell>
  <cell><cellProperties type="TRIANGLE"/><atomRef index="0"/><atomRef index="1"/><atomRef index="3"/></cell>
  <cell><cellProperties type="TRIANGLE"/><atomRef index="0"/><atomRef index="3"/><atomRef index="2"/></cell>
  <cell><cellProperties type="TRIANGLE"/><atomRef index="1"/><atomRef index="2"/><atomRef index="3"/></cell>
</structuralComponent>
</multiComponent></exclusiveComponents>
</physicalModel>
